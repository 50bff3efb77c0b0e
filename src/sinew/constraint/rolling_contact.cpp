// Contact points of a rigid body's shape, which follow the place where the shapes touch.
#include <algorithm>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/shape_contact.hpp"

namespace sinew::constraint {

ShapePlace ShapeContact::place_of(const RigidSide& side, const Configuration& configuration) const {
  const Eigen::Isometry3d pose = side.pose(configuration);
  return {pose, pose * side.rest_centre_of_mass};
}

ShapePlace ShapeContact::other_place(const Configuration& configuration,
                                     const mechanics::RollingPoint& rolling) const {
  if (carrier_) return place_of(*carrier_, configuration);
  return {rolling.surface, Vector3::Zero()};
}

// @param start,end poses of a surface of the world.
void ShapeContact::roll_from(std::size_t point, const Configuration& configuration,
                             const collision::TouchingPoint& found, const Eigen::Isometry3d& start,
                             const Eigen::Isometry3d& end, mechanics::RowValues& values) const {
  mechanics::RollingPoint& rolling = rolling_of(point, values);
  rolling.used = true;
  rolling.turning = mechanics::RollingPoint::Turning::fixed;
  rolling.surface = rolling.surface_ahead = end;
  rolling.frame = frame(point, values);
  rolling.offset = values.offset.segment<3>(row(point));
  const ShapePlace own = place_of(*own_, configuration);
  const Eigen::Isometry3d other = carrier_ ? carrier_->pose(configuration) : start;
  set_features(collision::moved(own_->shape, own.pose), collision::moved(surface_, other), found,
               rolling);
  const collision::TouchingPlace place =
      touching_place(rolling.own.feature, rolling.other.feature, found.normal);
  rolling.offset[0] -= found.gap - place.gap;
  const auto begin = [&](mechanics::RollingPoint::Side& side, const Eigen::Isometry3d& pose,
                         const Vector3& centre) {
    side.core = side.feature.at;
    side.lever = found.on_first - side.core;
    side.centre = centre;
    side.rotation = pose.linear();
    side.feature = side.feature.moved(pose.inverse());
  };
  begin(rolling.own, own.pose, own.centre);
  begin(rolling.other, other,
        carrier_ ? Vector3(other * carrier_->rest_centre_of_mass) : Vector3(Vector3::Zero()));
  write_rolled(configuration, point, roll(configuration, point, values), values);
}

Rolled ShapeContact::roll(const Configuration& configuration, std::size_t point,
                          const mechanics::RowValues& values) const {
  const mechanics::RollingPoint& rolling = rolling_of(point, values);
  Rolled now = rolled(rolling, place_of(*own_, configuration), other_place(configuration, rolling),
                      values.halved, !carrier_);
  now.motion += values.offset.segment<3>(row(point)) - rolling.offset;
  return now;
}

// On the carrier, efforts act opposite to those on the point.
void ShapeContact::write_rolled(const Configuration& configuration, std::size_t point,
                                const Rolled& now, mechanics::RowValues& values) const {
  const auto write = [&](const RigidSide& side, double sense, std::size_t first,
                         const Vector3& pressed, const Vector3& rubbed) {
    const Vector3 centre = configuration.position(side.centre);
    const Matrix3 turn = configuration.rotation(side.turn);
    for (int j = 0; j < 3; ++j) {
      const std::size_t at = entry(point, j) + first;
      const Vector3 lever = (j == 0 ? pressed : rubbed) - centre;
      values.arm[at] = turn.transpose() * lever;
      values.lever[at] = lever;
      values.direction[at] = sense * now.frame.col(j);
      values.direction[at + 1] = lever.cross(values.direction[at]);
    }
  };
  write(*own_, 1.0, 0, now.own_pressed, now.own_at);
  if (carrier_) write(*carrier_, -1.0, own_entries(), now.other_pressed, now.other_at);
}

double ShapeContact::turning_speed(const Configuration& configuration, std::size_t point,
                                   const mechanics::RowValues& values) const {
  constexpr auto kFace = collision::TouchingFeature::Kind::face;
  const mechanics::RollingPoint& rolling = rolling_of(point, values);
  if (!rolling.used || !rolling.may_turn) return 0.0;
  const auto first = rolling.own.feature.moved(own_->pose(configuration));
  const auto second = rolling.other.feature.moved(other_place(configuration, rolling).pose);
  const Vector3 normal = values.direction[entry(point)];
  Vector3 along = own_->velocity(configuration, first.at);
  if (carrier_) along -= carrier_->velocity(configuration, second.at);
  const double speed = normal.cross(along).norm();
  const auto turning = [&](const RigidSide& side) {
    return normal.cross(Vector3(configuration.velocity(side.turn))).norm();
  };
  double rate = 0.0;
  if (second.kind == kFace) {
    rate = carrier_ ? turning(*carrier_) : 0.0;
  } else if (first.kind == kFace) {
    rate = turning(*own_);
  } else {
    rate = speed / (first.at - second.at).norm();
  }
  const double slip = normal.cross(velocity_beside(configuration, point, values)).norm();
  return rate * std::max(speed, slip);
}

void ShapeContact::look_ahead(const Eigen::Isometry3d& pose, mechanics::RowValues& values) const {
  for (std::size_t k = 0; k < size(); ++k) rolling_of(k, values).surface_ahead = pose;
}

}  // namespace sinew::constraint
