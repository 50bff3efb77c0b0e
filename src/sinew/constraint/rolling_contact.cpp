// Contact points of a rigid body's shape, which follow the place where the shapes touch.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "sinew/collision/principal_frame.hpp"
#include "sinew/collision/touching_points.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/shape_contact.hpp"

namespace sinew::constraint {

namespace {

// The gap of an idle point, m: beyond anything that could touch.
constexpr double kIdle = 1e6;

// Cosine of the largest angle by which frames turn steadily in a step.
constexpr double kSameNormal = 0.9;

constexpr std::size_t kMost = collision::TouchingPoints::kMax;

// Index of the rows of each found point: those of the nearest point before, the nearest pair first,
// then the first unused ones. @param before (3,) m, where the points are that had rows before.
std::array<std::size_t, kMost> rows_for(const collision::TouchingPoints& found,
                                        const std::array<std::optional<Vector3>, kMost>& before) {
  std::array<std::size_t, kMost> rows{};
  std::array<bool, kMost> placed{}, taken{};
  for (std::size_t rounds = 0; rounds < found.size(); ++rounds) {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t point = kMost, row = kMost;
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (std::size_t k = 0; k < kMost; ++k) {
        if (placed[i] || taken[k] || !before[k]) continue;
        const double distance = (found[i].on_first - *before[k]).squaredNorm();
        if (!(distance < nearest)) continue;
        nearest = distance;
        point = i;
        row = k;
      }
    }
    if (point == kMost) break;
    rows[point] = row;
    placed[point] = taken[row] = true;
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (placed[i]) continue;
    rows[i] = static_cast<std::size_t>(std::ranges::find(taken, false) - taken.begin());
    taken[rows[i]] = true;
  }
  return rows;
}

// A frame with this normal. Tangents that jump, as those of a normal along an axis do with
// rounding, are replaced by those of the frame before, whose efforts go on.
Matrix3 frame_after(const Matrix3& before, const Vector3& normal) {
  Matrix3 frame = collision::tangent_frame(normal);
  const bool turned = !(normal.dot(before.col(0)) > kSameNormal);
  if (turned || frame.col(1).dot(before.col(1)) > kSameNormal) return frame;
  frame.col(1) = (before.col(1) - normal.dot(before.col(1)) * normal).normalized();
  frame.col(2) = normal.cross(frame.col(1));
  return frame;
}

}  // namespace

// If the motion of the surface is prescribed, the frames of the points move with it. Which corner
// of a face is found first may change with rounding: each point keeps the rows of the one that was
// nearest, since their efforts are its forces.
void ShapeContact::find_points(const Configuration& configuration, const Eigen::Isometry3d& start,
                               const Eigen::Isometry3d& end, mechanics::RowValues& values) const {
  const Eigen::Isometry3d carry = end * start.inverse();
  const collision::TouchingPoints found = collision::touching_points(
      collision::moved(own_->shape, own_->pose(configuration)), collision::moved(surface_, start),
      std::numeric_limits<double>::infinity());
  std::array<std::optional<Vector3>, kMost> before;
  for (std::size_t k = 0; k < size(); ++k) {
    const std::size_t at = entry(k, 1);
    if (!values.arm[at].isZero(0.0)) before[k] = own_->watched(configuration, at, values);
  }
  const auto rows_of = rows_for(found, before);
  std::array<bool, kMost> used{};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::size_t k = rows_of[i];
    used[k] = true;
    const Vector3 normal = carry.linear() * found[i].normal;
    const Matrix3 turned =
        before[k] ? frame_after(frame(k, values), normal) : collision::tangent_frame(normal);
    set_frame(k, carry * found[i].on_first, turned, found[i].gap, values);
    roll_from(k, configuration, found[i], start, end, values);
  }
  for (std::size_t k = 0; k < size(); ++k) {
    if (!used[k] && !idle(k, values)) put_away(k, values);
  }
}

// An idle point keeps this state, without a lever on either body, since the saved state of its rows
// does not tell when it became idle.
void ShapeContact::put_away(std::size_t point, mechanics::RowValues& values) const {
  set_frame(point, Vector3::Zero(), collision::tangent_frame(Vector3::UnitZ()), kIdle, values);
  values.delta.segment<3>(row(point)) = values.reference.segment<3>(row(point));
  rolling_of(point, values).used = false;
  const auto clear = [&](std::size_t centre, const Vector3& direction) {
    values.direction[centre] = direction;
    values.direction[centre + 1] = values.arm[centre] = values.lever[centre] = Vector3::Zero();
  };
  for (int j = 0; j < 3; ++j) {
    const Vector3 along = values.direction[entry(point, j)];
    clear(entry(point, j), along);
    if (carrier_) clear(entry(point, j) + own_entries(), -along);
  }
}

bool ShapeContact::idle(std::size_t point, const mechanics::RowValues& values) const {
  return own_ && values.reference[row(point)] == kIdle;
}

// After load(), as in a step, a point without a lever is idle: put_away().
bool ShapeContact::has_place(std::size_t point, const mechanics::RowValues& values) const {
  if (!own_) return true;
  return !values.arm.empty() && !idle(point, values) && !values.arm[entry(point, 1)].isZero(0.0);
}

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
