/// @file
/// Numbers that carry their derivatives (forward mode): exact to rounding, of fixed size, without
/// allocation.
#pragma once

#include <algorithm>
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

/// Derivatives by any number of variables, in passes of as many as a Dual<N> carries.
/// @param variables how many. @param direction of a variable: its number's gradient, zero; lent to
/// the pass and zero again after it. @param take called with the pass's first variable and how many
/// it has, in the order of the directions.
template <std::size_t N, typename Direction, typename Take>
void in_passes(std::size_t variables, const Direction& direction, const Take& take) {
  for (std::size_t from = 0; from < variables; from += N) {
    const std::size_t used = std::min(N, variables - from);
    for (std::size_t d = 0; d < used; ++d) direction(from + d)[d] = 1.0;
    take(from, used);
    for (std::size_t d = 0; d < used; ++d) direction(from + d)[d] = 0.0;
  }
}

}  // namespace sinew
