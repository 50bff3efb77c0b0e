#include "sinew/collision/coplanarity.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "sinew/collision/impact_bounds.hpp"

namespace sinew::collision {

namespace {

/// Relative rounding error of the coefficients, to the sum of absolute products: three units for
/// the differences, two for products, and those of sums of at most 8 terms make 13 units of 2^-53.
/// Doubled.
constexpr double kError = 13.0 * kEpsilon;
/// Relative rounding error of the part of a cubic between two times, to its largest coefficient:
/// three levels of interpolation with 4 units each. Doubled.
constexpr double kPartError = 12.0 * kEpsilon;
constexpr int kMaxClips = 40;

using Coefficients = std::array<double, 4>;

/// Shares of an interval between which the hull of the coefficients crosses zero downwards: before
/// `first` the cubic is positive; after `last` it is negative if the last coefficient is.
struct Crossings {
  double first = 1.0, last = 0.0;
};

// The hull is bounded by chords between coefficients.
Crossings crossings(const Coefficients& c) {
  Crossings result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      if (!(c[i] > 0.0 && c[j] <= 0.0)) continue;
      const double begin = static_cast<double>(i) / 3.0, way = static_cast<double>(j - i) / 3.0;
      const double share = begin + way * (c[i] / (c[i] - c[j]));
      result.first = std::min(result.first, share);
      result.last = std::max(result.last, share);
    }
  }
  return result;
}

}  // namespace

Coplanarity::Coplanarity(const MovingVector& x, const MovingVector& y, const MovingVector& z,
                         double separation) {
  const Vector3 first = y.start.cross(z.start), last = y.end.cross(z.end);
  const Vector3 middle = y.start.cross(z.end) + y.end.cross(z.start);
  bernstein_ = {x.start.dot(first), (x.end.dot(first) + x.start.dot(middle)) / 3.0,
                (x.end.dot(middle) + x.start.dot(last)) / 3.0, x.end.dot(last)};
  const auto size = [](const MovingVector& v) {
    return v.start.cwiseAbs().cwiseMax(v.end.cwiseAbs()).eval();
  };
  const Vector3 a = size(x), b = size(y), c = size(z);
  const Vector3 products(b[1] * c[2] + b[2] * c[1], b[2] * c[0] + b[0] * c[2],
                         b[0] * c[1] + b[1] * c[0]);
  double largest = 0.0;
  for (const double value : bernstein_) largest = std::max(largest, std::abs(value));
  error_ = kError * a.dot(products) + kPartError * largest + kUnderflow;
  if (separation > 0.0) {
    const double area = std::max({first.norm(), 0.5 * middle.norm(), last.norm()});
    error_ += separation * (area + kError * products.norm()) * (1.0 + kError);
  }
}

Coefficients Coplanarity::part(double from, double to) const {
  // Blossoms: one argument per level, each `from` or `to`.
  const auto blossom = [&](double t0, double t1, double t2) {
    const auto& b = bernstein_;
    const auto between = [](double p, double q, double t) { return (1.0 - t) * p + t * q; };
    const double p0 = between(b[0], b[1], t0), p1 = between(b[1], b[2], t0);
    const double p2 = between(b[2], b[3], t0);
    return between(between(p0, p1, t1), between(p1, p2, t1), t2);
  };
  return {blossom(from, from, from), blossom(from, from, to), blossom(from, to, to),
          blossom(to, to, to)};
}

double Coplanarity::apart_until(double time) const {
  double to = 1.0;
  for (int k = 0; k < kMaxClips && time < 1.0; ++k) {
    Coefficients c = part(time, to);
    const double sign = c[0] < 0.0 ? -1.0 : 1.0;
    for (double& value : c) value = sign * value - error_;
    if (!(c[0] > 0.0)) return time;
    const double length = to - time;
    if (std::min({c[1], c[2], c[3]}) > 0.0) {
      if (to == 1.0) return kNever;
      time = to;
      to = 1.0;
      continue;
    }
    const Crossings hull = crossings(c);
    const double end = time + length * (c[3] < 0.0 ? hull.last : 0.5);
    // Rounding of the share and of the product, relative to the length, and of the sum.
    const double next = (time + length * hull.first * (1.0 - 4.0 * kEpsilon)) * (1.0 - kEpsilon);
    if (!(next > time)) return time;
    time = next;
    to = std::clamp(end, time, 1.0);
  }
  return time;
}

}  // namespace sinew::collision
