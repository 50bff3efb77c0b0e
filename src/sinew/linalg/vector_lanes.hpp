/// @file
/// The widest vector of doubles of the target instruction set, by the vector extensions of GCC and
/// Clang.
#pragma once

#include <cstring>

namespace sinew::linalg {

#if defined(__AVX512F__)
inline constexpr int kLanes = 8;
using Lanes = double __attribute__((vector_size(64)));
#elif defined(__AVX__)
inline constexpr int kLanes = 4;
using Lanes = double __attribute__((vector_size(32)));
#else
inline constexpr int kLanes = 2;
using Lanes = double __attribute__((vector_size(16)));
#endif

inline Lanes load(const double* from) {
  Lanes x;
  std::memcpy(&x, from, sizeof x);
  return x;
}

inline void store(double* to, Lanes x) { std::memcpy(to, &x, sizeof x); }

inline Lanes broadcast(double x) {
#if defined(__AVX512F__)
  return Lanes{x, x, x, x, x, x, x, x};
#elif defined(__AVX__)
  return Lanes{x, x, x, x};
#else
  return Lanes{x, x};
#endif
}

}  // namespace sinew::linalg

/// Unrolls a loop over registers: an array stays in registers only if all its loops are unrolled.
#if defined(__clang__)
#define SINEW_UNROLL _Pragma("unroll")
#else
#define SINEW_UNROLL _Pragma("GCC unroll 16")
#endif
