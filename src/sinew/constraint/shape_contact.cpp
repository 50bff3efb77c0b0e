#include "sinew/constraint/shape_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "sinew/collision/principal_frame.hpp"
#include "sinew/collision/touching_points.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/core/error.hpp"

namespace sinew::constraint {

// Entries of a row: the point, or the centre and orientation of its body; then those of the
// carrier.
ShapeContact::ShapeContact(std::string name, std::vector<mechanics::MaterialPoint> points,
                           collision::Shape surface, Friction friction,
                           std::optional<RigidSide> carrier)
    : Contact(std::move(name), points.size(), friction, carrier ? 3 : 1),
      points_(std::move(points)),
      surface_(checked(std::move(surface))),
      carrier_(std::move(carrier)) {}

ShapeContact::ShapeContact(std::string name, RigidSide own, collision::Shape surface,
                           Friction friction, std::optional<RigidSide> carrier)
    : Contact(std::move(name), collision::TouchingPoints::kMax, friction, carrier ? 4 : 2),
      own_(std::move(own)),
      surface_(checked(std::move(surface))),
      carrier_(std::move(carrier)) {}

void ShapeContact::declare(mechanics::RowPattern& rows, std::vector<mechanics::StiffnessPair>&) {
  first_row_ = rows.rows();
  first_entry_ = rows.entries();
  row_count_ = 3 * static_cast<int>(size());
  std::vector<mechanics::Site> sites;
  for (std::size_t k = 0; k < size(); ++k) {
    sites.clear();
    if (own_) {
      sites.insert(sites.end(), {own_->centre, own_->turn});
    } else {
      sites.push_back(points_[k]);
    }
    if (carrier_) sites.insert(sites.end(), {carrier_->centre, carrier_->turn});
    for (int j = 0; j < 3; ++j) rows.add_row(sites, true);
  }
}

void ShapeContact::begin_step(const Configuration& configuration, const Eigen::Isometry3d& start,
                              const Eigen::Isometry3d& end, double time_step,
                              mechanics::RowValues& values) const {
  if (own_ || carrier_) prepare(values);
  const Eigen::Isometry3d carry = end * start.inverse();
  if (own_) return find_points(configuration, start, end, values);
  const bool rests = start.isApprox(end, 0.0);
  for (std::size_t i = 0; i < size(); ++i) {
    const Vector3 at = configuration.position(points_[i]);
    const Vector3 carried = rests ? at : Vector3(carry * at);
    Vector3 velocity = configuration.velocity(points_[i]);
    if (carrier_) velocity -= carrier_->velocity(configuration, at);
    const Vector3 towards = curved() ? Vector3(at + time_step * velocity)
                                     : carried;  // a plane is its own tangent plane anywhere
    place(i, carried, approach(carried, towards, end), values);
    if (carrier_) watch(configuration, i, at, values);
  }
}

// For a material point beside a rigid body. The gap's row watches the centre of curvature, which
// lies on the normal through the point.
void ShapeContact::watch(const Configuration& configuration, std::size_t point, const Vector3& at,
                         mechanics::RowValues& values) const {
  const Vector3 normal = values.direction[entry(point)];
  values.start[static_cast<std::size_t>(row(point))] = at;
  const Matrix3 turn = configuration.rotation(carrier_->turn);
  const double radius = collision::rounding_radius(surface_, turn.transpose() * normal);
  const double below = radius + values.reference[row(point)];
  const Vector3 core = radius > 0.0 ? Vector3(at - below * normal) : at;
  for (int j = 0; j < 3; ++j) {
    carrier_->watch(configuration, entry(point, j) + 1, j == 0 ? core : at, values);
  }
  write_carrier(configuration, point, values);
}

collision::ShapeApproach ShapeContact::approach(const Vector3& from, const Vector3& to,
                                                const Eigen::Isometry3d& pose) const {
  const Eigen::Isometry3d into = pose.inverse();
  collision::ShapeApproach result = collision::approach(surface_, into * from, into * to);
  result.at = pose * result.at;
  result.distance.normal = pose.linear() * result.distance.normal;
  return result;
}

void ShapeContact::place(std::size_t point, const Vector3& carried,
                         const collision::ShapeApproach& plane,
                         mechanics::RowValues& values) const {
  const Matrix3 frame = collision::tangent_frame(plane.distance.normal);
  const double gap = plane.distance.gap + frame.col(0).dot(carried - plane.at);
  set_frame(point, carried, frame, gap, values);
}

Vector3 ShapeContact::position_now(const Configuration& configuration, std::size_t point,
                                   const mechanics::RowValues& values) const {
  if (!own_) return configuration.position(points_[point]);
  if (values.arm.empty()) return configuration.position(own_->centre);
  return own_->watched(configuration, entry(point, 1), values);
}

Vector3 ShapeContact::position_beside(const Configuration& configuration, std::size_t point,
                                      const mechanics::RowValues& values) const {
  if ((!own_ && !carrier_) || values.arm.empty()) return position_now(configuration, point, values);
  if (own_) return position(point, roll(configuration, point, values).motion, values);
  const Vector3& start = values.start[static_cast<std::size_t>(row(point))];
  const auto moved = [&](int row) {
    return Vector3(configuration.position(points_[point]) - start -
                   carrier_->displacement(configuration, entry(point, row) + 1, values));
  };
  const Vector3 along = moved(1);
  const Vector3& normal = values.direction[entry(point)];
  return start + along + normal.dot(moved(0) - along) * normal;
}

Vector3 ShapeContact::velocity_beside(const Configuration& configuration, std::size_t point,
                                      const mechanics::RowValues& values) const {
  const Vector3 at = position_now(configuration, point, values);
  Vector3 result =
      own_ ? own_->velocity(configuration, at) : Vector3(configuration.velocity(points_[point]));
  if (carrier_) result -= carrier_->velocity(configuration, at);
  return result;
}

// On the carrier, efforts act opposite to those on the point.
void ShapeContact::write_carrier(const Configuration& configuration, std::size_t point,
                                 mechanics::RowValues& values) const {
  for (int j = 0; j < 3; ++j) {
    const Vector3 direction = values.direction[entry(point, j)];
    carrier_->write(configuration, entry(point, j) + 1, -direction, values);
  }
}

namespace {

// Shapes with edges get no principal curvatures.
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

Vector3 ShapeContact::place_nearest(std::size_t point, const Vector3& at,
                                    const Eigen::Isometry3d& pose,
                                    mechanics::RowValues& values) const {
  const Vector3 local = pose.inverse() * at;
  const collision::PrincipalFrame principal = nearest_frame(surface_, local);
  set_frame(point, at, pose.linear() * principal.frame, distance(surface_, local).gap, values);
  return principal.curvature;
}

void ShapeContact::set_frame(std::size_t point, const Vector3& carried, const Matrix3& frame,
                             double gap, mechanics::RowValues& values) const {
  const Vector3 reference(gap, 0.0, 0.0);
  for (int k = 0; k < 3; ++k) {
    values.direction[entry(point, k)] = frame.col(k);
  }
  values.reference.segment<3>(row(point)) = reference;
  values.offset.segment<3>(row(point)) = reference - frame.transpose() * carried;
}

Vector3 ShapeContact::row_values(std::size_t point, const Vector3& at,
                                 const mechanics::RowValues& values) const {
  Vector3 result = values.offset.segment<3>(row(point));
  for (int k = 0; k < 3; ++k) {
    result[k] += values.direction[entry(point, k)].dot(at);
  }
  return result;
}

Vector3 ShapeContact::position(std::size_t point, const Vector3& row_values,
                               const mechanics::RowValues& values) const {
  Vector3 result = Vector3::Zero();
  for (int k = 0; k < 3; ++k) {
    result += values.direction[entry(point, k)] * (row_values[k] - values.offset[row(point) + k]);
  }
  return result;
}

void ShapeContact::linearise(const Configuration& configuration,
                             mechanics::RowValues& values) const {
  const bool begun = !values.arm.empty();
  for (std::size_t i = 0; i < size(); ++i) {
    if (idle(i, values)) continue;
    if (own_) {
      if (!begun || !rolling_of(i, values).used) continue;  // a loaded state, no step
      const Rolled now = roll(configuration, i, values);
      write_rolled(configuration, i, now, values);
      values.delta.segment<3>(row(i)) = now.motion;
      continue;
    }
    if (carrier_ && begun) write_carrier(configuration, i, values);
    values.delta.segment<3>(row(i)) =
        row_values(i, position_beside(configuration, i, values), values);
  }
}

double ShapeContact::linear_gap(const Configuration& configuration, std::size_t point,
                                const mechanics::RowValues& values) const {
  if (own_) {
    return rolling_of(point, values).used ? roll(configuration, point, values).motion[0]
                                          : values.delta[row(point)];
  }
  return row_values(point, position_beside(configuration, point, values), values)[0];
}

double ShapeContact::gap_now(const Configuration& configuration, const Eigen::Isometry3d& pose,
                             std::size_t point, const mechanics::RowValues& values) const {
  return distance(surface_, pose.inverse() * position_now(configuration, point, values)).gap;
}

Vector3 ShapeContact::centre_velocity_beside(const Configuration& configuration,
                                             std::size_t point) const {
  Vector3 velocity = configuration.velocity(own_ ? own_->centre : points_[point]);
  if (carrier_) velocity -= configuration.velocity(carrier_->centre);
  return velocity;
}

// Along the normal, uses the centre of curvature, as the gap's row does.
Vector3 ShapeContact::shift(const Eigen::Isometry3d& back, const Configuration& configuration,
                            std::size_t point, const mechanics::RowValues& values) const {
  Vector3 result;
  for (int j = 0; j < 3; ++j) {
    const Vector3 at = own_ ? own_->watched(configuration, entry(point, j), values)
                            : configuration.position(points_[point]);
    result[j] = values.direction[entry(point, j)].dot(back * at - at);
  }
  return result;
}

double ShapeContact::deepest(const Configuration& configuration, const Eigen::Isometry3d& pose,
                             const mechanics::RowValues& values, double margin) const {
  double least = std::numeric_limits<double>::infinity();
  if (own_) {
    const auto found =
        collision::touching_points(collision::moved(own_->shape, own_->pose(configuration)),
                                   collision::moved(surface_, pose), margin);
    for (const collision::TouchingPoint& point : found) least = std::min(least, point.gap);
    return least;
  }
  for (std::size_t k = 0; k < size(); ++k) {
    least = std::min(least, gap_now(configuration, pose, k, values));
  }
  return least;
}

void ShapeContact::save(const mechanics::RowValues& values, double* to) const {
  for (std::size_t k = 0; k < size(); ++k) {
    to = std::copy_n(frame(k, values).data(), 9, to);
    if (!own_) continue;
    const Vector3 arm = values.arm.empty() ? Vector3(Vector3::Zero()) : values.arm[entry(k, 1)];
    to = std::copy_n(arm.data(), 3, to);
  }
}

void ShapeContact::load(const double* from, mechanics::RowValues& values) const {
  if (own_ && values.arm.empty()) prepare(values);
  for (std::size_t k = 0; k < size(); ++k) {
    if (own_) rolling_of(k, values).used = false;
    for (int j = 0; j < 3; ++j, from += 3) {
      values.direction[entry(k, j)] = Eigen::Map<const Vector3>(from);
    }
    if (!own_) continue;
    values.arm[entry(k, 1)] = Eigen::Map<const Vector3>(from);
    from += 3;
    values.reference[row(k)] = 0.0;  // the next step decides whether it is idle
  }
}

void ShapeContact::prepare(mechanics::RowValues& values) {
  if (!values.arm.empty()) return;
  for (auto* numbers : {&values.arm, &values.lever, &values.watched_start}) {
    numbers->resize(values.direction.size(), Vector3::Zero());
  }
  values.start.resize(values.active.size(), Vector3::Zero());
  values.rolling.resize(values.active.size() / 3 + 1);
}

namespace {

void describe_shape(const collision::Shape& shape, PartVisitor& visitor) {
  visitor.add(shape.index());
  if (const auto* plane = std::get_if<Plane>(&shape)) visitor.add(plane->point, plane->normal);
  if (const auto* ball = std::get_if<Sphere>(&shape)) visitor.add(ball->centre, ball->radius);
  if (const auto* rod = std::get_if<Capsule>(&shape)) visitor.add(rod->from, rod->to, rod->radius);
  if (const auto* rod = std::get_if<collision::Cylinder>(&shape)) {
    visitor.add(rod->from, rod->to, rod->radius);
  }
  if (const auto* box = std::get_if<collision::OrientedBox>(&shape)) {
    visitor.add(box->centre, box->axes, box->half_size);
  }
  if (const auto* solid = std::get_if<collision::ConvexSolid>(&shape)) {
    for (const Vector3& corner : solid->hull->corners()) visitor.add(corner);
    visitor.add(solid->origin, solid->axes);
  }
}

}  // namespace

void ShapeContact::describe(PartVisitor& visitor) const {
  friction().describe(visitor);
  describe_shape(surface_, visitor);
  if (own_) describe_shape(own_->shape, visitor);
}

}  // namespace sinew::constraint
