/// @file
/// A number type for derivatives along a motion and a variation of it. For a quantity f(q(t) + e w)
/// it has the value, the first and second derivatives with respect to t, and the variation, which
/// is the derivative with respect to e; all at t = 0, e = 0. Products follow Leibniz's rule.
#pragma once

#include <array>

#include "sinew/pcc/stumpff.hpp"

namespace sinew::pcc {

/// T is the type of the parts: a plain number, or one with derivatives of its own.
template <typename T>
struct Varied {
  T value{}, rate{}, acceleration{}, variation{};

  Varied() = default;
  Varied(double v) : value(v) {}  // NOLINT(google-explicit-constructor): constants mix in
  Varied(const T& f, const T& f_t, const T& f_tt, const T& f_e)
      : value(f), rate(f_t), acceleration(f_tt), variation(f_e) {}

  /// A function f of this number (chain rule). @param f0,f1,f2 f and its first two derivatives.
  Varied chain(const T& f0, const T& f1, const T& f2) const {
    return {f0, f1 * rate, f1 * acceleration + f2 * (rate * rate), f1 * variation};
  }
  Varied& operator+=(const Varied& b) {
    value += b.value;
    rate += b.rate;
    acceleration += b.acceleration;
    variation += b.variation;
    return *this;
  }
  Varied& operator-=(const Varied& b) {
    value -= b.value;
    rate -= b.rate;
    acceleration -= b.acceleration;
    variation -= b.variation;
    return *this;
  }
  friend Varied operator+(const Varied& a, const Varied& b) {
    return {a.value + b.value, a.rate + b.rate, a.acceleration + b.acceleration,
            a.variation + b.variation};
  }
  friend Varied operator-(const Varied& a, const Varied& b) {
    return {a.value - b.value, a.rate - b.rate, a.acceleration - b.acceleration,
            a.variation - b.variation};
  }
  friend Varied operator-(const Varied& a) { return -1.0 * a; }
  friend Varied operator*(const Varied& a, const Varied& b) {
    return {a.value * b.value, a.value * b.rate + a.rate * b.value,
            a.value * b.acceleration + 2.0 * (a.rate * b.rate) + a.acceleration * b.value,
            a.value * b.variation + a.variation * b.value};
  }
  friend Varied operator*(double a, const Varied& b) {
    return {a * b.value, a * b.rate, a * b.acceleration, a * b.variation};
  }
  friend Varied operator*(const Varied& a, double b) { return b * a; }
};

template <std::size_t K, typename T>
std::array<Varied<T>, K> stumpff(const Varied<T>& s) {
  const auto c = stumpff<K + 4>(s.value);
  const auto first = [&](std::size_t k) -> T {
    return 0.5 * (static_cast<double>(k) * c[k + 2] - c[k + 1]);
  };
  std::array<Varied<T>, K> result;
  for (std::size_t k = 0; k < K; ++k) {
    result[k] =
        s.chain(c[k], first(k), 0.5 * (static_cast<double>(k) * first(k + 2) - first(k + 1)));
  }
  return result;
}

}  // namespace sinew::pcc
