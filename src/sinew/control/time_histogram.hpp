/// @file
/// How often times of so many microseconds occurred.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace sinew::control {

/// Bins of one microsecond up to a millisecond, and one for what is longer. One thread adds, any
/// other may read at the same time.
class TimeHistogram {
 public:
  static constexpr int kBins = 1000;

  /// @param seconds negative ones count as 0.
  void add(double seconds);
  std::int64_t count() const;
  /// (kBins + 1,) times within [k, k + 1) us; the last those of a millisecond and more.
  std::vector<std::int64_t> counts() const;
  /// s: the upper end of the bin in which this part of all times ends; the longest time where that
  /// is the last bin; 0 without any. @param part 0..1: 0.5 for the median.
  double quantile(double part) const;
  double longest() const { return longest_.load(std::memory_order_relaxed); }  ///< s

 private:
  std::array<std::atomic<std::int64_t>, kBins + 1> counts_{};
  std::atomic<double> longest_{0.0};
};

}  // namespace sinew::control
