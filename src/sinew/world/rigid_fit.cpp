#include "sinew/world/rigid_fit.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/linalg/dense.hpp"

namespace sinew::world {

namespace {

// Smaller parts of a motion or a coordinate, relative to the whole, are not told.
constexpr double kUntold = 1e-3;
// An axis farther away than this many radii of the points is no axis: they move along a line.
constexpr double kFarAxis = 100.0;
constexpr double kLeft = 0.1;

}  // namespace

std::string place_text(const Vector3& at, double size) {
  const Vector3 shown = at.unaryExpr([&](double x) { return std::abs(x) < 1e-6 * size ? 0.0 : x; });
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", shown.x(), shown.y(), shown.z());
}

// With r = x - centre, the normal equations of the rotation are
//   sum (r.r I - r r^T) w = sum r x u.
// Points on a line do not tell the rotation about it: the pseudo-inverse takes none.
RigidFit::RigidFit(const Points& points, const Points& displacements)
    : centre(points.colwise().mean().transpose()),
      translation(displacements.colwise().mean().transpose()) {
  Matrix3 inertia = Matrix3::Zero();
  Vector3 moment = Vector3::Zero();
  double squares = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vector3 r = points.row(i).transpose() - centre;
    const Vector3 u = displacements.row(i).transpose();
    inertia += r.squaredNorm() * Matrix3::Identity() - r * r.transpose();
    moment += r.cross(u);
    squares += r.squaredNorm();
  }
  reach = std::sqrt(squares / static_cast<double>(points.rows()));
  if (squares > 0.0) {
    rotation = linalg::pseudo_inverse(MatrixX(inertia / squares)) * (moment / squares);
  }
  double left = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vector3 r = points.row(i).transpose() - centre;
    left += (displacements.row(i).transpose() - translation - rotation.cross(r)).squaredNorm();
  }
  is_rigid = std::sqrt(left) <= kLeft * displacements.norm();
}

std::string RigidFit::text() const {
  if (!is_rigid) return "moves freely";
  const double turned = rotation.norm(), moved = translation.norm();
  if (turned * reach <= kUntold * moved || moved >= kFarAxis * turned * reach) {
    return fmt::format("moves freely along {}", place_text(translation / moved, 1.0));
  }
  const Vector3 axis = rotation / turned;
  const Vector3 through = centre + rotation.cross(translation) / (turned * turned);
  const double along = std::abs(axis.dot(translation));
  return fmt::format("turns freely about the axis through {} m along {}{}",
                     place_text(through, reach), place_text(axis, 1.0),
                     along > kLeft * turned * reach ? ", and moves along it" : "");
}

}  // namespace sinew::world
