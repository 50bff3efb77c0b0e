/// @file
/// Numbers that carry their derivatives (forward mode): Dual with a gradient, SecondDual with a
/// gradient and a Hessian. Exact to rounding, of fixed size, without allocation; loops over the
/// directions vectorise.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace sinew {

namespace dual_detail {

// GCC ignores a vector size that depends on a template parameter.
template <std::size_t N>
struct LanesOf;
template <>
struct LanesOf<1> {
  using Type = double __attribute__((vector_size(8)));
};
template <>
struct LanesOf<2> {
  using Type = double __attribute__((vector_size(16)));
};
template <>
struct LanesOf<8> {
  using Type = double __attribute__((vector_size(64)));
};

}  // namespace dual_detail

/// value + sum_i grad[i] e_i, products of e_i dropped. N is 1, 2 or 8: the gradient is a
/// vector of lanes, so that an operation is a few instructions whatever the optimiser sees.
template <std::size_t N>
struct Dual {
  using Lanes = typename dual_detail::LanesOf<N>::Type;
  double value;
  Lanes grad;

  Dual() : value(0.0), grad{} {}
  Dual(double v) : value(v), grad{} {}  // NOLINT(google-explicit-constructor): constants mix in
  Dual(double v, const Lanes& g) : value(v), grad(g) {}
  /// The variable that direction `i` is the derivative with respect to.
  static Dual variable(double v, std::size_t i) {
    Dual result(v);
    result.grad[i] = 1.0;
    return result;
  }

  /// f of this number: value f0, derivative f1.
  Dual chain(double f0, double f1) const { return {f0, f1 * grad}; }
  Dual& operator+=(const Dual& b) {
    value += b.value;
    grad += b.grad;
    return *this;
  }
  Dual& operator-=(const Dual& b) {
    value -= b.value;
    grad -= b.grad;
    return *this;
  }
  friend Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.grad + b.grad};
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.grad - b.grad};
  }
  friend Dual operator-(const Dual& a) { return {-a.value, -a.grad}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.value * b.grad + b.value * a.grad};
  }
  friend Dual operator*(double a, const Dual& b) { return {a * b.value, a * b.grad}; }
  friend Dual operator*(const Dual& a, double b) { return b * a; }
};

/// The same to second order, with the whole symmetric Hessian: row i in lanes.
template <std::size_t N>
struct SecondDual {
  using Lanes = typename dual_detail::LanesOf<N>::Type;
  double value;
  Lanes grad;
  std::array<Lanes, N> hess;

  SecondDual() : SecondDual(0.0) {}
  SecondDual(double v)  // NOLINT(google-explicit-constructor): constants mix in
      : value(v), grad{}, hess{} {}
  static SecondDual variable(double v, std::size_t i) {
    SecondDual result(v);
    result.grad[i] = 1.0;
    return result;
  }

  /// f of this number: value f0, derivatives f1 and f2.
  SecondDual chain(double f0, double f1, double f2) const {
    return make(f0, f1 * grad, [&](std::size_t i) { return f1 * hess[i] + (f2 * grad[i]) * grad; });
  }
  SecondDual& operator+=(const SecondDual& b) { return *this = *this + b; }
  SecondDual& operator-=(const SecondDual& b) { return *this = *this - b; }
  friend SecondDual operator+(const SecondDual& a, const SecondDual& b) {
    return make(a.value + b.value, a.grad + b.grad,
                [&](std::size_t i) { return a.hess[i] + b.hess[i]; });
  }
  friend SecondDual operator-(const SecondDual& a, const SecondDual& b) {
    return make(a.value - b.value, a.grad - b.grad,
                [&](std::size_t i) { return a.hess[i] - b.hess[i]; });
  }
  friend SecondDual operator-(const SecondDual& a) { return -1.0 * a; }
  friend SecondDual operator*(const SecondDual& a, const SecondDual& b) {
    return make(a.value * b.value, a.value * b.grad + b.value * a.grad, [&](std::size_t i) {
      return a.value * b.hess[i] + b.value * a.hess[i] + a.grad[i] * b.grad + b.grad[i] * a.grad;
    });
  }
  friend SecondDual operator*(double a, const SecondDual& b) {
    return make(a * b.value, a * b.grad, [&](std::size_t i) { return a * b.hess[i]; });
  }
  friend SecondDual operator*(const SecondDual& a, double b) { return b * a; }

 private:
  struct Unset {};
  explicit SecondDual(Unset) {}  // NOLINT(cppcoreguidelines-pro-type-member-init): make() fills it
  template <typename Row>
  static SecondDual make(double value, const Lanes& grad, const Row& row) {
    SecondDual result{Unset{}};
    result.value = value;
    result.grad = grad;
    for (std::size_t i = 0; i < N; ++i) result.hess[i] = row(i);
    return result;
  }
};

}  // namespace sinew
