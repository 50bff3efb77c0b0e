#include "sinew/constraint/contact.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/collision/principal_frame.hpp"
#include "sinew/constraint/placement.hpp"
#include "sinew/core/error.hpp"

namespace sinew::constraint {

Contact::Contact(std::string name, std::vector<mechanics::MaterialPoint> points,
                 collision::Shape surface, double friction, std::optional<Carrier> carrier)
    : Constraint(std::move(name)),
      points_(std::move(points)),
      surface_(checked(std::move(surface))),
      friction_(friction),
      carrier_(std::move(carrier)),
      stride_(carrier_ ? 3 : 1) {
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
    for (int k = 0; k < 3; ++k) {
      if (carrier_) {
        rows.add_row({point, carrier_->centre, carrier_->turn}, true);
      } else {
        rows.add_row({point}, true);
      }
    }
  }
}

void Contact::begin_step(const Placement& placement, const Eigen::Isometry3d& start,
                         const Eigen::Isometry3d& end, double time_step,
                         mechanics::RowValues& values) const {
  const Eigen::Isometry3d carry = end * start.inverse();
  const bool rests = start.isApprox(end, 0.0);
  if (carrier_) begin_carried(placement, values);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vector3 at = placement.position(points_[i]);
    const Vector3 carried = rests ? at : Vector3(carry * at);
    const Vector3 towards = curved()
                                ? Vector3(at + time_step * velocity_beside(placement, i, values))
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

Eigen::Isometry3d Contact::carried_pose(const Placement& placement) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = placement.rotation(carrier_->turn);
  pose.translation() = placement.position(carrier_->centre) - pose.linear() * carrier_->rest_centre;
  return pose;
}

void Contact::begin_carried(const Placement& placement, mechanics::RowValues& values) const {
  const auto rows = values.present.size();
  for (auto* numbers : {&values.carried_arm, &values.carried_lever, &values.carried_start}) {
    if (numbers->size() < rows) numbers->resize(rows, Vector3::Zero());
  }
  const Vector3 centre = placement.position(carrier_->centre);
  const Matrix3 turn = placement.rotation(carrier_->turn);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto at = static_cast<std::size_t>(row(i));
    values.carried_start[at] = placement.position(points_[i]);
    values.carried_lever[at] = values.carried_start[at] - centre;
    values.carried_arm[at] = turn.transpose() * values.carried_lever[at];
  }
}

Vector3 Contact::position_beside(const Placement& placement, std::size_t point,
                                 const mechanics::RowValues& values) const {
  const Vector3 at = placement.position(points_[point]);
  if (!carrier_ || values.carried_arm.empty()) return at;
  const auto first = static_cast<std::size_t>(row(point));
  const Vector3 carried = placement.position(carrier_->centre) +
                          placement.rotation(carrier_->turn) * values.carried_arm[first];
  return at - (carried - values.carried_start[first]);
}

Vector3 Contact::velocity_beside(const Placement& placement, std::size_t point,
                                 const mechanics::RowValues& values) const {
  const Vector3 own = placement.velocity(points_[point]);
  if (!carrier_ || values.carried_arm.empty()) return own;
  const Vector3& lever = values.carried_lever[static_cast<std::size_t>(row(point))];
  return own - placement.velocity(carrier_->centre) -
         placement.velocity(carrier_->turn).cross(lever);
}

Matrix3 Contact::frame(std::size_t point, const mechanics::RowValues& values) const {
  Matrix3 result;
  for (int k = 0; k < 3; ++k) result.col(k) = values.direction[entry(point, k)];
  return result;
}

// What a row's effort does to the carrier: the opposite force at y.
void Contact::write_carrier(std::size_t point, mechanics::RowValues& values) const {
  const Vector3& lever = values.carried_lever[static_cast<std::size_t>(row(point))];
  for (int k = 0; k < 3; ++k) {
    Vector3* directions = &values.direction[entry(point, k)];
    directions[1] = -directions[0];
    directions[2] = -lever.cross(directions[0]);
  }
}

namespace {

// Edges have no principal curvatures; faces have none.
collision::PrincipalFrame nearest_frame(const collision::Shape& surface, const Vector3& point) {
  return std::visit(
      [&](const auto& own) -> collision::PrincipalFrame {
        if constexpr (requires { principal_frame(own, point); }) {
          return principal_frame(own, point);
        } else {
          return {collision::tangent_frame(distance(own, point).normal), Vector3::Zero()};
        }
      },
      surface);
}

}  // namespace

Vector3 Contact::place_nearest(std::size_t point, const Vector3& at, const Eigen::Isometry3d& pose,
                               mechanics::RowValues& values) const {
  const Vector3 local = pose.inverse() * at;
  const collision::PrincipalFrame principal = nearest_frame(surface_, local);
  set_frame(point, at, pose.linear() * principal.frame, distance(surface_, local).gap, values);
  return principal.curvature;
}

void Contact::set_frame(std::size_t point, const Vector3& carried, const Matrix3& frame, double gap,
                        mechanics::RowValues& values) const {
  const Vector3 reference(gap, 0.0, 0.0);
  for (int k = 0; k < 3; ++k) {
    values.direction[entry(point, k)] = frame.col(k);
  }
  if (carrier_) write_carrier(point, values);
  values.reference.segment<3>(row(point)) = reference;
  values.offset.segment<3>(row(point)) = reference - frame.transpose() * carried;
}

Vector3 Contact::row_values(std::size_t point, const Vector3& at,
                            const mechanics::RowValues& values) const {
  Vector3 result = values.offset.segment<3>(row(point));
  for (int k = 0; k < 3; ++k) {
    result[k] += values.direction[entry(point, k)].dot(at);
  }
  return result;
}

Vector3 Contact::position(std::size_t point, const Vector3& row_values,
                          const mechanics::RowValues& values) const {
  Vector3 result = Vector3::Zero();
  for (int k = 0; k < 3; ++k) {
    result += values.direction[entry(point, k)] * (row_values[k] - values.offset[row(point) + k]);
  }
  return result;
}

void Contact::linearise(const Placement& placement, mechanics::RowValues& values) const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (carrier_ && !values.carried_arm.empty()) {
      const auto first = static_cast<std::size_t>(row(i));
      values.carried_lever[first] = placement.rotation(carrier_->turn) * values.carried_arm[first];
      write_carrier(i, values);
    }
    values.delta.segment<3>(row(i)) = row_values(i, position_beside(placement, i, values), values);
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
  if (const auto* box = std::get_if<collision::OrientedBox>(&surface_)) {
    hash.add(box->centre, box->axes, box->half_size);
  }
  if (const auto* rod = std::get_if<collision::Cylinder>(&surface_)) {
    hash.add(rod->from, rod->to, rod->radius);
  }
  if (const auto* plane = std::get_if<Plane>(&surface_)) hash.add(plane->point, plane->normal);
  if (const auto* ball = std::get_if<Sphere>(&surface_)) hash.add(ball->centre, ball->radius);
  if (const auto* rod = std::get_if<Capsule>(&surface_)) hash.add(rod->from, rod->to, rod->radius);
}

}  // namespace sinew::constraint
