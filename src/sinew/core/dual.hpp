/// @file
/// Dual numbers for forward-mode differentiation: exact to rounding, of fixed size, without
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

/// The dual number value + sum_i grad[i] e_i with e_i e_j = 0. N is 1, 2 or 8. The gradient is a
/// vector type, so each operation is a few instructions and does not depend on the optimiser.
template <std::size_t N>
struct Dual {
  using Lanes = typename dual_detail::LanesOf<N>::Type;
  double value;
  Lanes grad;

  Dual() : value(0.0), grad{} {}
  Dual(double v) : value(v), grad{} {}  // NOLINT(google-explicit-constructor): constants mix in
  Dual(double v, const Lanes& g) : value(v), grad(g) {}
  /// The variable of direction `i`: grad[i] is the derivative with respect to it.
  static Dual variable(double v, std::size_t i) {
    Dual result(v);
    result.grad[i] = 1.0;
    return result;
  }

  /// f(*this), from the value f0 = f(value) and the derivative f1 = f'(value).
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

/// Differentiates with respect to any number of variables, in passes of at most N.
/// @param variables how many. @param direction returns the gradient of variable k, which must be
///   zero; the pass sets one entry of it and zeroes it afterwards. @param take called in each pass
///   with its first variable and the number of its variables; variable first + d has direction d.
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
