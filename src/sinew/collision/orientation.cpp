#include "sinew/collision/orientation.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

namespace sinew::collision {

namespace {

/// Error of the determinants relative to the sum of absolute products: 7.8e-16 and 3.4e-16
/// (Shewchuk 1997, section 4), rounded up.
constexpr double kErrorInSpace = 1e-15;
constexpr double kErrorInPlane = 5e-16;
/// Below this size, products may have lost digits to underflow.
constexpr double kMinSize = 1e-250;

/// A value as the exact sum of two doubles.
struct Two {
  double high, low;
};

Two sum(double a, double b) {
  const double high = a + b, part = high - a;
  return {high, (a - (high - part)) + (b - part)};
}

Two product(double a, double b) {
  const double high = a * b;
  return {high, std::fma(a, b, -high)};
}

/// A sum without rounding, as non-overlapping parts of increasing size (Shewchuk 1997, theorem 10).
class ExactSum {
 public:
  void add(double value) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      const Two both = sum(value, parts_[k]);
      value = both.high;
      if (both.low != 0.0) parts_[kept++] = both.low;
    }
    if (value != 0.0) parts_[kept++] = value;
    count_ = kept;
  }
  void add_product(const Two& x, const Two& y, double factor) {
    for (const double a : {x.high, x.low}) {
      for (const double b : {y.high, y.low}) {
        if (a == 0.0 || b == 0.0) continue;
        const Two ab = product(a, b);
        for (const double part : {ab.high, ab.low}) {
          const Two scaled = product(part, factor);
          add(scaled.low);
          add(scaled.high);
        }
      }
    }
  }
  int sign() const {
    if (count_ == 0) return 0;
    return parts_[count_ - 1] > 0.0 ? 1 : -1;
  }

 private:
  std::array<double, 400> parts_;  // 6 triple products of two-part numbers have at most 192 parts
  std::size_t count_ = 0;
};

using TwoVector = std::array<Two, 3>;

TwoVector exact_difference(const Vector3& a, const Vector3& b) {
  return {sum(a[0], -b[0]), sum(a[1], -b[1]), sum(a[2], -b[2])};
}

int exact_orientation(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const TwoVector u = exact_difference(b, a), v = exact_difference(c, a);
  const TwoVector w = exact_difference(d, a);
  ExactSum total;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    for (const double part : {u[k].high, u[k].low}) {
      if (part == 0.0) continue;
      total.add_product(v[i], w[j], part);
      total.add_product(v[j], w[i], -part);
    }
  }
  return total.sign();
}

int sign_of(double value) { return value > 0.0 ? 1 : -1; }

}  // namespace

int orientation(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const Vector3 u = b - a, v = c - a, w = d - a;
  const double value = u.dot(v.cross(w));
  const Vector3 x = u.cwiseAbs(), y = v.cwiseAbs(), z = w.cwiseAbs();
  const double size = x[0] * (y[1] * z[2] + y[2] * z[1]) + x[1] * (y[2] * z[0] + y[0] * z[2]) +
                      x[2] * (y[0] * z[1] + y[1] * z[0]);
  if (size > kMinSize && std::abs(value) > kErrorInSpace * size) return sign_of(value);
  return exact_orientation(a, b, c, d);
}

int orientation_along(int axis, const Vector3& a, const Vector3& b, const Vector3& c) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double left = (b[i] - a[i]) * (c[j] - a[j]), right = (b[j] - a[j]) * (c[i] - a[i]);
  const double value = left - right, size = std::abs(left) + std::abs(right);
  if (size > kMinSize && std::abs(value) > kErrorInPlane * size) return sign_of(value);
  const Two ui = sum(b[i], -a[i]), uj = sum(b[j], -a[j]);
  const Two vi = sum(c[i], -a[i]), vj = sum(c[j], -a[j]);
  ExactSum total;
  total.add_product(ui, vj, 1.0);
  total.add_product(uj, vi, -1.0);
  return total.sign();
}

}  // namespace sinew::collision
