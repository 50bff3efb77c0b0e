#include "sinew/constraint/contact.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/placement.hpp"
#include "sinew/core/error.hpp"

namespace sinew::constraint {

Contact::Contact(std::string name, std::vector<mechanics::MaterialPoint> points, Surface surface,
                 double friction)
    : Constraint(std::move(name)),
      points_(std::move(points)),
      surface_(checked(std::move(surface))),
      friction_(friction) {
  if (!(friction >= 0.0) || !std::isfinite(friction)) {
    throw Error(ErrorKind::out_of_range, {},
                fmt::format("the friction coefficient is {:g}", friction), "give zero or more");
  }
  if (points_.empty()) {
    throw Error(ErrorKind::too_few_points, {}, "no point can touch the surface",
                "name a region that has nodes that are not fixed");
  }
}

void Contact::declare(mechanics::RowPattern& rows, std::vector<mechanics::RowCurvature>&) {
  first_row_ = rows.rows();
  first_entry_ = rows.entries();
  row_count_ = 3 * static_cast<int>(points_.size());
  for (const auto& point : points_) {
    for (int k = 0; k < 3; ++k) rows.add_row({point}, true);
  }
}

void Contact::begin_step(const Placement& placement, const Eigen::Isometry3d& start,
                         const Eigen::Isometry3d& end, mechanics::RowValues& values) const {
  const Eigen::Isometry3d carry = end * start.inverse();
  const Eigen::Isometry3d into = end.inverse();
  const bool rests = start.isApprox(end, 0.0);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vector3 at = placement.position(points_[i]);
    const Vector3 carried = rests ? at : Vector3(carry * at);
    const SurfaceDistance under = distance(surface_, into * carried);
    const Matrix3 frame = tangent_frame(end.linear() * under.normal);
    const Vector3 reference(under.gap, 0.0, 0.0);
    for (int k = 0; k < 3; ++k) {
      values.direction[entry(i) + static_cast<std::size_t>(k)] = frame.col(k);
      values.reference[row(i) + k] = reference[k];
      values.offset[row(i) + k] = reference[k] - frame.col(k).dot(carried);
    }
  }
}

void Contact::linearise(const Placement& placement, mechanics::RowValues& values) const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vector3 at = placement.position(points_[i]);
    for (int k = 0; k < 3; ++k) {
      values.delta[row(i) + k] = values.direction[entry(i) + static_cast<std::size_t>(k)].dot(at) +
                                 values.offset[row(i) + k];
    }
  }
}

SurfaceDistance Contact::distance_now(const Placement& placement, const Eigen::Isometry3d& pose,
                                      std::size_t point) const {
  SurfaceDistance result = distance(surface_, pose.inverse() * placement.position(points_[point]));
  result.normal = pose.linear() * result.normal;
  return result;
}

}  // namespace sinew::constraint
