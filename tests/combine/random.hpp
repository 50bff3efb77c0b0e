/// @file
/// Random numbers that are the same on every machine. The engines of the standard library are
/// portable, but its distributions are not.
#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace sinew::combine {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// An integer from 0 to count - 1.
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  double uniform(double from, double to) {
    return from + (to - from) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (int k = static_cast<int>(items.size()); k > 1; --k) {
      std::swap(items[static_cast<std::size_t>(k - 1)], items[static_cast<std::size_t>(below(k))]);
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace sinew::combine
