/// @file
/// Stumpff's functions, which describe a bent arc without a singularity at the straight pose,
///   c_k(s) = sum_i (-s)^i / (k + 2i)!,   s = theta^2,
/// so that c_0 = cos theta, c_1 = sin theta / theta, c_2 = (1 - cos theta) / theta^2,
/// c_3 = (theta - sin theta) / theta^3 (Stumpff 1959). They are entire, with
///   c_k + s c_(k+2) = 1/k!,   dc_k/ds = (k c_(k+2) - c_(k+1)) / 2,
/// so they are closed under differentiation, and no formula needs a branch at theta = 0.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <type_traits>

#include "sinew/core/dual.hpp"

namespace sinew::pcc {

namespace stumpff_detail {

constexpr std::array<double, 34> kInverseFactorial = [] {
  std::array<double, 34> result{};
  double factorial = 1.0;
  for (std::size_t k = 0; k < result.size(); ++k) {
    if (k > 0) factorial *= static_cast<double>(k);
    result[k] = 1.0 / factorial;
  }
  return result;
}();

/// Largest s for the series. Its remainder after 11 terms is below 1e-15 of the sum, and the
/// downward recursion c_k = 1/k! - s c_(k+2) loses no accuracy.
constexpr double kSeries = 10.0;
constexpr std::size_t kTerms = 11;

template <typename T>
T series(std::size_t k, const T& s) {
  T sum = kInverseFactorial[k + 2 * (kTerms - 1)];
  for (std::size_t i = kTerms - 1; i-- > 0;) sum = kInverseFactorial[k + 2 * i] - s * sum;
  return sum;
}

}  // namespace stumpff_detail

/// c_0 .. c_(K-1) at a real or complex number, K >= 2.
template <std::size_t K, typename T>
requires(std::is_same_v<T, double> ||
         std::is_same_v<T, std::complex<double>>) std::array<T, K> stumpff(const T& s) {
  using stumpff_detail::kInverseFactorial;
  static_assert(K >= 2 && K <= 13);
  std::array<T, K> c;
  if (std::real(s) < stumpff_detail::kSeries) {
    c[K - 1] = stumpff_detail::series(K - 1, s);
    c[K - 2] = stumpff_detail::series(K - 2, s);
    for (std::size_t k = K - 2; k-- > 0;) c[k] = kInverseFactorial[k] - s * c[k + 2];
  } else {
    const T angle = std::sqrt(s);
    c[0] = std::cos(angle);
    c[1] = std::sin(angle) / angle;
    for (std::size_t k = 2; k < K; ++k) c[k] = (kInverseFactorial[k - 2] - c[k - 2]) / s;
  }
  return c;
}

template <std::size_t K, std::size_t N>
std::array<Dual<N>, K> stumpff(const Dual<N>& s) {
  const auto c = stumpff<K + 2>(s.value);
  std::array<Dual<N>, K> result;
  for (std::size_t k = 0; k < K; ++k) {
    result[k] = s.chain(c[k], 0.5 * (static_cast<double>(k) * c[k + 2] - c[k + 1]));
  }
  return result;
}

}  // namespace sinew::pcc
