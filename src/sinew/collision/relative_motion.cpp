#include "sinew/collision/relative_motion.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/collision/impact_bounds.hpp"

namespace sinew::collision {

namespace {

/// Rounding error of n.d relative to sum |n_k d_k|: one unit for the difference, one for the
/// product and two for the sum make 4 units of 2^-53; those of the bound itself are below one more.
/// Doubled.
constexpr double kDotError = 5.0 * kEpsilon;
/// Error of a quotient of two rounded numbers without cancellation: 2 units, doubled.
constexpr double kQuotientError = 2.0 * kEpsilon;

}  // namespace

bool RelativeMotion::finite() const {
  // Zero times a finite number is zero; times infinity it is NaN.
  Lanes zero = Lanes::Zero();
  for (std::size_t k = 0; k < 3; ++k) zero += 0.0 * start_[k] + 0.0 * end_[k];
  return (zero == 0.0).all();
}

bool RelativeMotion::apart_along_axis() const {
  // If a rounded difference is beyond a double, so is the exact one.
  for (std::size_t k = 0; k < 3; ++k) {
    if (start_[k].min(end_[k]).minCoeff() > separation_) return true;
    if (start_[k].max(end_[k]).maxCoeff() < -separation_) return true;
  }
  return false;
}

double RelativeMotion::separated_until(const Vector3& normal, double time) const {
  const double largest = normal.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) return time;
  const Vector3 n = normal / largest;  // so that products do not all underflow
  const double offset = separation_ * n.norm() * (1.0 + 8.0 * kEpsilon) + kUnderflow;
  const auto lower_bound = [&](const std::array<Lanes, 3>& d) -> Lanes {
    const Lanes x = n[0] * d[0], y = n[1] * d[1], z = n[2] * d[2];
    return x + y + z - kDotError * (x.abs() + y.abs() + z.abs() + offset) - offset;
  };
  const Lanes first = lower_bound(start_), last = lower_bound(end_);
  if (first.min(last).minCoeff() > 0.0) return kNever;
  double until = kNever;
  for (int j = 0; j < 4; ++j) {
    if (first[j] > 0.0 && last[j] > 0.0) continue;
    const double crossing = first[j] / (first[j] - last[j]);
    if (first[j] > 0.0) {
      until = std::min(until, crossing * (1.0 - kQuotientError));
    } else if (!(last[j] > 0.0) || !(time > crossing * (1.0 + kQuotientError))) {
      return time;
    }
  }
  return until > time ? until : time;
}

Vector3 RelativeMotion::at(int j, double time) const {
  Vector3 result;
  for (std::size_t k = 0; k < 3; ++k) {
    result[static_cast<Eigen::Index>(k)] = start_[k][j] + time * (end_[k][j] - start_[k][j]);
  }
  return result;
}

}  // namespace sinew::collision
