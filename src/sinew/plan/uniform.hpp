/// @file
/// Uniform random numbers for starts and disturbances.
#pragma once

#include <cstdint>
#include <random>

#include "sinew/core/types.hpp"

namespace sinew::plan {

/// A generator with a seed. Recorded plans and braces depend on its sequence.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : engine_(seed) {}

  /// A number in [from, to).
  double operator()(double from, double to) {
    return from + (to - from) * std::generate_canonical<double, 53>(engine_);
  }
  /// A vector (n,), each component within its own bounds. @param from,to (n,).
  VectorX vector(const VectorX& from, const VectorX& to) {
    VectorX result(from.size());
    for (Eigen::Index i = 0; i < from.size(); ++i) result[i] = (*this)(from[i], to[i]);
    return result;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace sinew::plan
