/// @file
/// Uniform random numbers for starts and disturbances.
#pragma once

#include <cstdint>
#include <random>

#include "sinew/core/types.hpp"

namespace sinew::plan {

/// Of a seed; the recorded plans and braces are those of this sequence.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : engine_(seed) {}

  /// In [from, to).
  double operator()(double from, double to) {
    return from + (to - from) * std::generate_canonical<double, 53>(engine_);
  }
  /// (n,), each between its own bounds. @param from,to (n,).
  VectorX vector(const VectorX& from, const VectorX& to) {
    VectorX result(from.size());
    for (Eigen::Index i = 0; i < from.size(); ++i) result[i] = (*this)(from[i], to[i]);
    return result;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace sinew::plan
