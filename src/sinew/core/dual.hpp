/// @file
/// Numbers that carry their derivatives (forward mode): Dual with a gradient, SecondDual with a
/// gradient and a Hessian. Exact to rounding, of fixed size, without allocation; loops over the
/// directions vectorise.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace sinew {

/// value + sum_i grad[i] e_i, products of e_i dropped.
template <std::size_t N>
struct Dual {
  double value = 0.0;
  std::array<double, N> grad{};

  Dual() = default;
  Dual(double v) : value(v) {}  // NOLINT(google-explicit-constructor): constants mix with variables
  /// The variable that direction `i` is the derivative with respect to.
  static Dual variable(double v, std::size_t i) {
    Dual result(v);
    result.grad[i] = 1.0;
    return result;
  }

  /// f of this number: value f0, derivative f1.
  Dual chain(double f0, double f1) const {
    Dual result(f0);
    for (std::size_t i = 0; i < N; ++i) result.grad[i] = f1 * grad[i];
    return result;
  }
  Dual& operator+=(const Dual& b) {
    value += b.value;
    for (std::size_t i = 0; i < N; ++i) grad[i] += b.grad[i];
    return *this;
  }
  Dual& operator-=(const Dual& b) {
    value -= b.value;
    for (std::size_t i = 0; i < N; ++i) grad[i] -= b.grad[i];
    return *this;
  }
  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator-(const Dual& a) { return a.chain(-a.value, -1.0); }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual result(a.value * b.value);
    for (std::size_t i = 0; i < N; ++i) result.grad[i] = a.value * b.grad[i] + b.value * a.grad[i];
    return result;
  }
  friend Dual operator*(double a, const Dual& b) { return b.chain(a * b.value, a); }
  friend Dual operator*(const Dual& a, double b) { return b * a; }
};

/// The same to second order. The Hessian is symmetric: entry (i, j), j <= i, at i (i + 1) / 2 + j.
template <std::size_t N>
struct SecondDual {
  static constexpr std::size_t kPairs = N * (N + 1) / 2;
  double value = 0.0;
  std::array<double, N> grad{};
  std::array<double, kPairs> hess{};

  SecondDual() = default;
  SecondDual(double v)  // NOLINT(google-explicit-constructor): constants mix with variables
      : value(v) {}
  static SecondDual variable(double v, std::size_t i) {
    SecondDual result(v);
    result.grad[i] = 1.0;
    return result;
  }

  /// f of this number: value f0, derivatives f1 and f2.
  SecondDual chain(double f0, double f1, double f2) const {
    SecondDual result(f0);
    for (std::size_t i = 0; i < N; ++i) result.grad[i] = f1 * grad[i];
    for (std::size_t i = 0, p = 0; i < N; p += ++i) {
      const double scaled = f2 * grad[i];
      for (std::size_t j = 0; j <= i; ++j) {
        result.hess[p + j] = f1 * hess[p + j] + scaled * grad[j];
      }
    }
    return result;
  }
  SecondDual& operator+=(const SecondDual& b) {
    value += b.value;
    for (std::size_t i = 0; i < N; ++i) grad[i] += b.grad[i];
    for (std::size_t p = 0; p < kPairs; ++p) hess[p] += b.hess[p];
    return *this;
  }
  SecondDual& operator-=(const SecondDual& b) {
    value -= b.value;
    for (std::size_t i = 0; i < N; ++i) grad[i] -= b.grad[i];
    for (std::size_t p = 0; p < kPairs; ++p) hess[p] -= b.hess[p];
    return *this;
  }
  friend SecondDual operator+(SecondDual a, const SecondDual& b) { return a += b; }
  friend SecondDual operator-(SecondDual a, const SecondDual& b) { return a -= b; }
  friend SecondDual operator-(const SecondDual& a) { return -1.0 * a; }
  friend SecondDual operator*(const SecondDual& a, const SecondDual& b) {
    SecondDual result(a.value * b.value);
    for (std::size_t i = 0; i < N; ++i) result.grad[i] = a.value * b.grad[i] + b.value * a.grad[i];
    for (std::size_t i = 0, p = 0; i < N; p += ++i) {
      const double ga = a.grad[i], gb = b.grad[i];
      for (std::size_t j = 0; j <= i; ++j) {
        result.hess[p + j] =
            a.value * b.hess[p + j] + b.value * a.hess[p + j] + ga * b.grad[j] + gb * a.grad[j];
      }
    }
    return result;
  }
  friend SecondDual operator*(double a, const SecondDual& b) {
    SecondDual result(a * b.value);
    for (std::size_t i = 0; i < N; ++i) result.grad[i] = a * b.grad[i];
    for (std::size_t p = 0; p < kPairs; ++p) result.hess[p] = a * b.hess[p];
    return result;
  }
  friend SecondDual operator*(const SecondDual& a, double b) { return b * a; }
};

}  // namespace sinew
