#include "sinew/qp/friction_cone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace sinew::qp {

namespace {

constexpr int kMaxIterations = 200;
constexpr double kAtLimit = 1e-7;  // of the limit
constexpr double kRounding = std::numeric_limits<double>::epsilon();

}  // namespace

const char* contact_state_name(ContactState state) {
  switch (state) {
    case ContactState::open:
      return "open";
    case ContactState::stick:
      return "stick";
    case ContactState::slip:
      return "slip";
  }
  return "unknown";
}

bool slides(const Vector3& effort, double friction) {
  return effort.tail<2>().norm() >= (1.0 - kAtLimit) * friction * effort[0];
}

bool at_most(const Vector3& effort, double friction) {
  return effort.tail<2>().norm() <= (1.0 + kAtLimit) * friction * effort[0];
}

Vector3 project_on_cone(const Vector3& r, double friction) {
  const double across = r.tail<2>().norm();
  if (r[0] >= 0.0 && across <= friction * r[0]) return r;
  const double along = r[0] + friction * across;
  if (along <= 0.0) return Vector3::Zero();  // in the polar cone
  const double normal = along / (1.0 + friction * friction);
  Vector3 result(normal, 0.0, 0.0);
  if (across > 0.0) result.tail<2>() = (friction * normal / across) * r.tail<2>();
  return result;
}

void ConeEquation::set(const Matrix3& w, double friction) {
  w_ = w;
  friction_ = friction;
  inverse_ = w.inverse();
  const Eigen::Vector2d coupling = w.block<2, 1>(1, 0);
  const Eigen::Matrix2d schur = w.block<2, 2>(1, 1) - coupling * coupling.transpose() / w(0, 0);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen;
  eigen.computeDirect(schur);
  directions_ = eigen.eigenvectors();
  values_ = eigen.eigenvalues().cwiseMax(0.0);
  coupling_ = directions_.transpose() * coupling;
}

Vector3 ConeEquation::solve(const Vector3& q) const {
  if (q[0] >= 0.0) return Vector3::Zero();
  if (friction_ == 0.0) return {-q[0] / w_(0, 0), 0.0, 0.0};
  Vector3 stick = -(inverse_ * q);
  if (stick.tail<2>().norm() <= friction_ * stick[0]) return stick;
  return slip(q);
}

Vector3 ConeEquation::slip(const Vector3& q) const {
  const double normal = w_(0, 0);
  const Eigen::Vector2d b = directions_.transpose() * q.tail<2>() - coupling_ * (q[0] / normal);
  double low = 0.0;
  double high = b.norm() * (normal + friction_ * coupling_.norm()) / (friction_ * -q[0]);
  double s = 0.0;
  Eigen::Vector2d r_t = Eigen::Vector2d::Zero();
  double r_n = 0.0;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::Vector2d softer = values_.array() + s;
    r_t = -b.cwiseQuotient(softer);
    r_n = -(q[0] + coupling_.dot(r_t)) / normal;
    const double across = r_t.norm();
    const double excess = across - friction_ * r_n;
    if (std::abs(excess) <= 2.0 * kRounding * across) break;
    (excess > 0.0 ? low : high) = s;
    if (high - low <= kRounding * high) break;
    double next = -1.0;
    if (r_n > 0.0) {
      const Eigen::Vector2d change = -r_t.cwiseQuotient(softer);  // of r_t by s
      const double across_change = r_t.dot(change) / across;
      const double normal_change = -coupling_.dot(change) / normal;
      const double value = 1.0 / across - 1.0 / (friction_ * r_n);
      const double slope =
          -across_change / (across * across) + normal_change / (friction_ * r_n * r_n);
      next = s - value / slope;
    }
    // Outside the bracket: takes its middle, the geometric mean if it spans orders of magnitude.
    const bool inside = next > low && next < high;
    s = inside ? next : (low > 0.0 ? std::sqrt(low * high) : 0.5 * high);
    if (!inside && low == 0.0) s = std::min(s, std::max(values_[1], kRounding * high));
    if (!(s > low)) s = 0.5 * (low + high);
  }
  Vector3 result;
  result << r_n, directions_ * r_t;
  const double across = r_t.norm();
  if (across > 0.0) result.tail<2>() *= friction_ * r_n / across;  // on the cone to the last bit
  return result;
}

}  // namespace sinew::qp
