/// @file
/// Conversion between one array per quantity (SoA, in kernels) and one record per element (AoS, for
/// gathers).
#pragma once

#include <cstdint>
#include <cstring>

#include "sinew/material/lanes.hpp"

namespace sinew::fem {

/// Four doubles: a 3-vector and its padding.
using Quad = double __attribute__((vector_size(32)));
using QuadMask = std::int64_t __attribute__((vector_size(32)));

SINEW_INLINE Quad load_quad(const double* source) {
  Quad value;
  std::memcpy(&value, source, sizeof value);
  return value;
}

SINEW_INLINE void store_quad(double* target, const Quad& value) {
  std::memcpy(target, &value, sizeof value);
}

/// The first three components, with 0 as the fourth.
SINEW_INLINE Quad without_padding(const Quad& value) {
  const QuadMask mask{-1, -1, -1, 0};
  return (Quad)((QuadMask)value & mask);
}

namespace detail {

/// Even and odd lanes of (a, b), interleaved: a 2x2 transposition within pairs of lanes.
SINEW_INLINE material::Lanes even(const material::Lanes& a, const material::Lanes& b) {
  return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
}
SINEW_INLINE material::Lanes odd(const material::Lanes& a, const material::Lanes& b) {
  return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
}
/// The same with pairs in place of single lanes.
SINEW_INLINE material::Lanes even_pairs(const material::Lanes& a, const material::Lanes& b) {
  return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
}
SINEW_INLINE material::Lanes odd_pairs(const material::Lanes& a, const material::Lanes& b) {
  return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
}

}  // namespace detail

/// Loads eight points into x, y and z lanes.
/// @param points (n, 4) padded positions.
/// @param nodes eight node numbers.
/// @param result x, y and z of the eight points.
SINEW_INLINE void load_points(const double* points, const std::int32_t* nodes,
                              material::Lanes (&result)[3]) {
  using namespace detail;
  const auto pair = [&](int k) {  // element k in the lower half, k + 4 in the upper
    const Quad low = load_quad(points + 4 * static_cast<std::int64_t>(nodes[k]));
    const Quad high = load_quad(points + 4 * static_cast<std::int64_t>(nodes[k + 4]));
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
  };
  const material::Lanes c0 = pair(0), c1 = pair(1), c2 = pair(2), c3 = pair(3);
  const material::Lanes e0 = even(c0, c1), e1 = even(c2, c3), o0 = odd(c0, c1), o1 = odd(c2, c3);
  result[0] = even_pairs(e0, e1);
  result[1] = even_pairs(o0, o1);
  result[2] = odd_pairs(e0, e1);
}

/// Writes eight quantities of eight elements as eight doubles in each element's record.
/// @param rows rows[k] holds quantity k of all elements.
/// @param target eight doubles of element e go to target + stride e.
/// @param stride doubles in a record.
SINEW_INLINE void store_records(const material::Lanes* rows, double* target, int stride) {
  using namespace detail;
  material::Lanes u[8], v[8];
  for (int k = 0; k < 8; k += 2) {
    u[k] = even(rows[k], rows[k + 1]);
    u[k + 1] = odd(rows[k], rows[k + 1]);
  }
  for (int k = 0; k < 8; k += 4) {
    v[k] = even_pairs(u[k], u[k + 2]);
    v[k + 1] = even_pairs(u[k + 1], u[k + 3]);
    v[k + 2] = odd_pairs(u[k], u[k + 2]);
    v[k + 3] = odd_pairs(u[k + 1], u[k + 3]);
  }
  for (int k = 0; k < 4; ++k) {
    material::store(target + stride * k,
                    __builtin_shufflevector(v[k], v[k + 4], 0, 1, 2, 3, 8, 9, 10, 11));
    material::store(target + stride * (k + 4),
                    __builtin_shufflevector(v[k], v[k + 4], 4, 5, 6, 7, 12, 13, 14, 15));
  }
}

}  // namespace sinew::fem
