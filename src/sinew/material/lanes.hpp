/// @file
/// SIMD vectors of eight doubles, one per element. They are GCC and clang vector extensions, which
/// the compiler maps to the registers of the target (one AVX-512, two AVX, four SSE). Everything
/// here is inlined into kernels; Lanes never cross a library boundary by value.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

// How wide vectors are passed depends on the target; all such calls are inlined, so the ABI warning
// does not apply.
#pragma GCC diagnostic ignored "-Wpsabi"

#define SINEW_INLINE [[gnu::always_inline]] inline

namespace sinew::material {

inline constexpr int kLanes = 8;

using Lanes = double __attribute__((vector_size(64)));
/// Result of a comparison of Lanes: all bits set where true.
using LaneMask = std::int64_t __attribute__((vector_size(64)));

SINEW_INLINE Lanes lanes(double value) {
  return Lanes{value, value, value, value, value, value, value, value};
}

/// @param source eight doubles, any alignment.
SINEW_INLINE Lanes load(const double* source) {
  Lanes value;
  std::memcpy(&value, source, sizeof value);
  return value;
}

SINEW_INLINE void store(double* target, const Lanes& value) {
  std::memcpy(target, &value, sizeof value);
}

SINEW_INLINE Lanes select(const LaneMask& mask, const Lanes& yes, const Lanes& no) {
  return mask ? yes : no;
}

/// True if any lane of the mask is set.
SINEW_INLINE bool any(const LaneMask& mask) {
  std::int64_t bits = 0;
  for (int k = 0; k < kLanes; ++k) bits |= mask[k];
  return bits != 0;
}

SINEW_INLINE Lanes square_root(const Lanes& value) {
  alignas(64) double part[kLanes];
  store(part, value);
  for (double& x : part) x = std::sqrt(x);
  return load(part);
}

/// Sum of all lanes, added in pairs.
SINEW_INLINE double sum(const Lanes& value) {
  return ((value[0] + value[1]) + (value[2] + value[3])) +
         ((value[4] + value[5]) + (value[6] + value[7]));
}

SINEW_INLINE Lanes maximum(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
SINEW_INLINE Lanes absolute(const Lanes& a) { return a < 0.0 ? -a : a; }

/// A 3x3 matrix in every lane: m[r][c].
struct Lanes3x3 {
  Lanes m[3][3];
  SINEW_INLINE Lanes* operator[](int row) { return m[row]; }
  SINEW_INLINE const Lanes* operator[](int row) const { return m[row]; }
};

/// A symmetric 3x3 matrix in every lane.
struct LanesSymmetric {
  Lanes xx, yy, zz, xy, xz, yz;
};

/// F^T F.
SINEW_INLINE LanesSymmetric gram(const Lanes3x3& f) {
  const auto column = [&](int a, int b) {
    return f[0][a] * f[0][b] + f[1][a] * f[1][b] + f[2][a] * f[2][b];
  };
  return {column(0, 0), column(1, 1), column(2, 2), column(0, 1), column(0, 2), column(1, 2)};
}

/// cof F = det(F) F^-T, which is also d(det F)/dF.
SINEW_INLINE Lanes3x3 cofactor(const Lanes3x3& f) {
  Lanes3x3 result;
  for (int r = 0; r < 3; ++r) {
    const int r1 = (r + 1) % 3, r2 = (r + 2) % 3;
    for (int c = 0; c < 3; ++c) {
      const int c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      result[r][c] = f[r1][c1] * f[r2][c2] - f[r1][c2] * f[r2][c1];
    }
  }
  return result;
}

/// det F from F and its cofactor matrix.
SINEW_INLINE Lanes determinant(const Lanes3x3& f, const Lanes3x3& cof) {
  return f[0][0] * cof[0][0] + f[0][1] * cof[0][1] + f[0][2] * cof[0][2];
}

/// F C for symmetric C.
SINEW_INLINE Lanes3x3 multiply(const Lanes3x3& f, const LanesSymmetric& c) {
  Lanes3x3 result;
  for (int r = 0; r < 3; ++r) {
    result[r][0] = f[r][0] * c.xx + f[r][1] * c.xy + f[r][2] * c.xz;
    result[r][1] = f[r][0] * c.xy + f[r][1] * c.yy + f[r][2] * c.yz;
    result[r][2] = f[r][0] * c.xz + f[r][1] * c.yz + f[r][2] * c.zz;
  }
  return result;
}

}  // namespace sinew::material
