#include "sinew/contact/zone_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sinew::contact {

namespace {

// Sweeps end when none changes a force by more than this fraction of the zone's force.
constexpr double kSettled = 1e-4;
constexpr int kMaxSweeps = 50;

}  // namespace

Vector3 ZoneEstimate::force_change(const std::vector<ZonePoint>& points, const Vector3& compliance,
                                   double spread) {
  begin(points, compliance, spread);
  if (!(normal_ > 0.0 && tangential_ > 0.0)) return Vector3::Zero();
  double largest = kInfinity;
  for (int sweep = 0; sweep < kMaxSweeps && largest > kSettled * total_; ++sweep) {
    largest = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) largest = std::max(largest, relax(points, i));
  }
  Vector3 sum = Vector3::Zero();
  for (const Vector3& change : change_) sum += change;
  return sum;
}

void ZoneEstimate::begin(const std::vector<ZonePoint>& points, const Vector3& compliance,
                         double spread) {
  const std::size_t n = points.size();
  change_.assign(n, Vector3::Zero());
  kernel_.resize(n * n);
  Vector3 resultant = Vector3::Zero();
  for (const ZonePoint& point : points) resultant += point.force;
  total_ = resultant[0];
  double own = 0.0;  // of the normal forces' shares
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      kernel_[i * n + j] = 1.0 / std::hypot((points[i].place - points[j].place).norm(), spread);
      own += kernel_[i * n + j] * points[i].force[0] * points[j].force[0];
    }
  }
  const double scale = own > 0.0 ? total_ * total_ / own : 0.0;
  normal_ = scale * compliance[0];
  tangential_ = scale * 0.5 * (compliance[1] + compliance[2]);
}

// (3,) m, motion in the frame of a point.
Vector3 ZoneEstimate::motion(const std::vector<ZonePoint>& points, std::size_t i) const {
  Vector3 way = Vector3::Zero();
  for (std::size_t j = 0; j < points.size(); ++j) {
    const Vector3 normal = points[j].frame.col(0);
    const double along = normal.dot(change_[j]);
    way += kernel_[i * points.size() + j] *
           (tangential_ * change_[j] + (normal_ - tangential_) * along * normal);
  }
  return points[i].motion + points[i].frame.transpose() * way;
}

// Solves Coulomb's law at one point with a diagonal compliance. @return change of its force, N.
double ZoneEstimate::relax(const std::vector<ZonePoint>& points, std::size_t i) {
  const ZonePoint& point = points[i];
  const double own = kernel_[i * points.size() + i];
  const Vector3 before = point.force + point.frame.transpose() * change_[i];
  const Vector3 way = motion(points, i);
  Vector3 force;
  force[0] = std::max(0.0, before[0] - way[0] / (normal_ * own));
  force.tail<2>() = before.tail<2>() - way.tail<2>() / (tangential_ * own);
  const double limit = point.friction * force[0], size = force.tail<2>().norm();
  if (size > limit) force.tail<2>() *= limit / size;
  change_[i] = point.frame * (force - point.force);
  return (force - before).norm();
}

}  // namespace sinew::contact
