/// @file
/// Loops over short contiguous columns, whose lengths are padded to whole registers, so that the
/// compiler needs no remainder loops.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::qp {

/// Columns are padded to a multiple of this many doubles.
constexpr int kColumnGrain = 4;

/// `count` rounded up to whole registers.
inline int padded_length(int count) {
  return (count + kColumnGrain - 1) / kColumnGrain * kColumnGrain;
}

/// y += a x, over `count` entries.
inline void add_scaled(double* __restrict y, double a, const double* __restrict x, int count) {
  for (int i = 0; i < count; ++i) y[i] += a * x[i];
}

/// x . y in a fixed order of summation.
inline double dot(const double* x, const double* y, int count) {
  using Column = Eigen::Map<const VectorX>;
  return Column(x, count).dot(Column(y, count));
}

}  // namespace sinew::qp
