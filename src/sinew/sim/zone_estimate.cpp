#include "sinew/sim/zone_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sinew::sim {

namespace {

// Sweeps end where none changes a force by more than this part of the zone's.
constexpr double kSettled = 1e-4;
constexpr int kMaxSweeps = 50;

class LocalProblem {
 public:
  LocalProblem(const std::vector<ZonePoint>& points, const Vector3& compliance, double spread)
      : points_(points), n_(points.size()), spread_(spread), change_(n_, Vector3::Zero()) {
    kernel_.resize(n_ * n_);
    Vector3 resultant = Vector3::Zero();
    for (const ZonePoint& point : points_) resultant += point.force;
    total_ = resultant[0];
    double own = 0.0;  // of the normal forces' shares
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) {
        kernel_[i * n_ + j] =
            1.0 / std::hypot((points_[i].place - points_[j].place).norm(), spread);
        own += kernel_[i * n_ + j] * points_[i].force[0] * points_[j].force[0];
      }
    }
    const double scale = own > 0.0 ? total_ * total_ / own : 0.0;
    normal_ = scale * compliance[0];
    tangential_ = scale * 0.5 * (compliance[1] + compliance[2]);
  }

  Vector3 solve() {
    if (!(normal_ > 0.0 && tangential_ > 0.0)) return Vector3::Zero();
    double largest = kInfinity;
    for (int sweep = 0; sweep < kMaxSweeps && largest > kSettled * total_; ++sweep) {
      largest = 0.0;
      for (std::size_t i = 0; i < n_; ++i) largest = std::max(largest, relax(i));
    }
    Vector3 sum = Vector3::Zero();
    for (const Vector3& change : change_) sum += change;
    return sum;
  }

 private:
  // (3,) m, in the frame of a point.
  Vector3 motion(std::size_t i) const {
    Vector3 way = Vector3::Zero();
    for (std::size_t j = 0; j < n_; ++j) {
      const Vector3 normal = points_[j].frame.col(0);
      const double along = normal.dot(change_[j]);
      way += kernel_[i * n_ + j] *
             (tangential_ * change_[j] + (normal_ - tangential_) * along * normal);
    }
    return points_[i].motion + points_[i].frame.transpose() * way;
  }

  // Coulomb's law of a point by itself, whose compliance is diagonal. N: how far its force changes.
  double relax(std::size_t i) {
    const ZonePoint& point = points_[i];
    const double own = kernel_[i * n_ + i];
    const Vector3 before = point.force + point.frame.transpose() * change_[i], way = motion(i);
    Vector3 force;
    force[0] = std::max(0.0, before[0] - way[0] / (normal_ * own));
    force.tail<2>() = before.tail<2>() - way.tail<2>() / (tangential_ * own);
    const double limit = point.friction * force[0], size = force.tail<2>().norm();
    if (size > limit) force.tail<2>() *= limit / size;
    change_[i] = point.frame * (force - point.force);
    return (force - before).norm();
  }

  const std::vector<ZonePoint>& points_;
  std::size_t n_;
  double spread_;
  double total_ = 0.0;                      // N, of normal forces
  double normal_ = 0.0, tangential_ = 0.0;  // b_n and b_t, m^2/N
  std::vector<double> kernel_;              // (n, n) 1/m
  std::vector<Vector3> change_;             // (n,) N, in world axes
};

}  // namespace

Vector3 zone_force_change(const std::vector<ZonePoint>& points, const Vector3& compliance,
                          double spread) {
  return LocalProblem(points, compliance, spread).solve();
}

}  // namespace sinew::sim
