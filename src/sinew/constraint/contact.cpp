#include "sinew/constraint/contact.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/collision/principal_frame.hpp"
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
                         const Eigen::Isometry3d& end, double time_step,
                         mechanics::RowValues& values) const {
  const Eigen::Isometry3d carry = end * start.inverse();
  const bool rests = start.isApprox(end, 0.0);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vector3 at = placement.position(points_[i]);
    const Vector3 carried = rests ? at : Vector3(carry * at);
    const Vector3 towards = curved() ? Vector3(at + time_step * placement.velocity(points_[i]))
                                     : carried;  // a plane is its own tangent plane anywhere
    place(i, carried, approach(carried, towards, end), values);
  }
}

collision::ShapeApproach Contact::approach(const Vector3& from, const Vector3& to,
                                           const Eigen::Isometry3d& pose) const {
  const Eigen::Isometry3d into = pose.inverse();
  collision::ShapeApproach result = collision::approach(surface_, into * from, into * to);
  result.at = pose * result.at;
  result.distance.normal = pose.linear() * result.distance.normal;
  return result;
}

void Contact::place(std::size_t point, const Vector3& carried,
                    const collision::ShapeApproach& plane, mechanics::RowValues& values) const {
  const Matrix3 frame = collision::tangent_frame(plane.distance.normal);
  const double gap = plane.distance.gap + frame.col(0).dot(carried - plane.at);
  set_frame(point, carried, frame, gap, values);
}

Vector3 Contact::place_nearest(std::size_t point, const Vector3& at, const Eigen::Isometry3d& pose,
                               mechanics::RowValues& values) const {
  const Vector3 local = pose.inverse() * at;
  const collision::PrincipalFrame principal = principal_frame(surface_, local);
  set_frame(point, at, pose.linear() * principal.frame, distance(surface_, local).gap, values);
  return principal.curvature;
}

void Contact::set_frame(std::size_t point, const Vector3& carried, const Matrix3& frame, double gap,
                        mechanics::RowValues& values) const {
  const Vector3 reference(gap, 0.0, 0.0);
  for (int k = 0; k < 3; ++k) {
    values.direction[entry(point) + static_cast<std::size_t>(k)] = frame.col(k);
  }
  values.reference.segment<3>(row(point)) = reference;
  values.offset.segment<3>(row(point)) = reference - frame.transpose() * carried;
}

Vector3 Contact::row_values(std::size_t point, const Vector3& at,
                            const mechanics::RowValues& values) const {
  Vector3 result = values.offset.segment<3>(row(point));
  for (int k = 0; k < 3; ++k) {
    result[k] += values.direction[entry(point) + static_cast<std::size_t>(k)].dot(at);
  }
  return result;
}

Vector3 Contact::position(std::size_t point, const Vector3& row_values,
                          const mechanics::RowValues& values) const {
  Vector3 result = Vector3::Zero();
  for (int k = 0; k < 3; ++k) {
    result += values.direction[entry(point) + static_cast<std::size_t>(k)] *
              (row_values[k] - values.offset[row(point) + k]);
  }
  return result;
}

void Contact::linearise(const Placement& placement, mechanics::RowValues& values) const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    values.delta.segment<3>(row(i)) = row_values(i, placement.position(points_[i]), values);
  }
}

collision::ShapeDistance Contact::distance_now(const Placement& placement,
                                               const Eigen::Isometry3d& pose,
                                               std::size_t point) const {
  collision::ShapeDistance result =
      distance(surface_, pose.inverse() * placement.position(points_[point]));
  result.normal = pose.linear() * result.normal;
  return result;
}

void Contact::add_to(ValueHash& hash) const {
  hash.add(friction_, surface_.index());
  if (const auto* plane = std::get_if<Plane>(&surface_)) hash.add(plane->point, plane->normal);
  if (const auto* ball = std::get_if<Sphere>(&surface_)) hash.add(ball->centre, ball->radius);
  if (const auto* rod = std::get_if<Capsule>(&surface_)) hash.add(rod->from, rod->to, rod->radius);
}

}  // namespace sinew::constraint
