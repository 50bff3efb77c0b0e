#include "sinew/constraint/rolled.hpp"

#include <cmath>

#include "sinew/core/rotation.hpp"

namespace sinew::constraint {

namespace {

using collision::TouchingFeature;
using mechanics::RollingPoint;

// Cosine of the largest angle by which a normal follows its features in a step. Beyond it, bodies
// could pass through each other unnoticed.
constexpr double kSameSide = 0.5;
// Permitted difference between a contact point and the place where its features touch: of normals,
// and of positions relative to the radii and distances there. Points are found iteratively.
constexpr double kSame = 1e-6;

// The ball about the centre of curvature, or the material point at `sharp`.
TouchingFeature material(const collision::Shape& shape, const Vector3& on, const Vector3& outward,
                         const Vector3& sharp) {
  const double radius = collision::rounding_radius(shape, outward);
  const Vector3 at = radius > 0.0 ? Vector3(on - radius * outward) : sharp;
  return {TouchingFeature::Kind::point, at, Vector3::Zero(), radius};
}

bool agrees(const collision::TouchingPlace& place, const collision::TouchingPoint& found,
            double size) {
  return (place.on_first - found.on_first).norm() + (place.on_second - found.on_second).norm() <=
             kSame * size &&
         (place.normal - found.normal).norm() <= kSame;
}

double sine_ratio(double angle) {
  return angle < 1e-4 ? 1.0 - angle * angle / 6.0 : std::sin(angle) / angle;
}

// (3,) m: see RollingPoint. @param core,lever the present X and r.
Vector3 travel(const RollingPoint::Side& side, const ShapePlace& now, const Vector3& core,
               const Vector3& lever, bool halved) {
  const Matrix3 rotation = now.pose.linear();
  if (!halved) {
    const Vector3 moved = core - side.core, mean = 0.5 * (side.lever + lever);
    if (mean.isZero(0.0) || rotation == side.rotation) return moved;
    return moved + rotation_vector(rotation * side.rotation.transpose()).cross(mean);
  }
  const Vector3 turn = rotation_vector(rotation * side.rotation.transpose());
  const Vector3 arm = sine_ratio(turn.norm()) * (core - now.centre) + lever;
  return now.centre - side.centre + turn.cross(arm);
}

// The same for a surface of the world in a halved step, from its motion in the whole step.
Vector3 half_of_whole(const RollingPoint& point, const Vector3& lever) {
  const RollingPoint::Side& side = point.other;
  const Matrix3 turn = point.surface_ahead.linear() * side.rotation.transpose();
  const Vector3 moved = point.surface_ahead * side.feature.at - side.core;
  return 0.5 * (moved + rotation_vector(turn).cross(lever));
}

// The place with the normal of the features, unless it has turned too far. Returns whether it has
// not.
bool follow(const RollingPoint& point, const TouchingFeature& first, const TouchingFeature& second,
            collision::TouchingPlace& place) {
  const collision::TouchingPlace there = turned_place(first, second, point.frame.col(0));
  if (!(there.normal.dot(point.frame.col(0)) > kSameSide)) return false;
  place = there;
  return true;
}

// The frame, turned to a normal by the smallest rotation.
Matrix3 turned(const Matrix3& frame, const Vector3& normal) {
  Matrix3 result =
      Eigen::Quaterniond::FromTwoVectors(frame.col(0), normal).toRotationMatrix() * frame;
  result.col(0) = normal;
  return result;
}

}  // namespace

void set_features(const collision::Shape& own, const collision::Shape& other,
                  const collision::TouchingPoint& found, RollingPoint& result) {
  TouchingFeature& first = result.own.feature;
  TouchingFeature& second = result.other.feature;
  first = collision::touching_feature(own, found.on_first, -found.normal);
  second = collision::touching_feature(other, found.on_second, found.normal);
  const double size = first.radius + second.radius + (found.on_first - found.on_second).norm() +
                      (found.on_first - first.at).norm() + (found.on_second - second.at).norm();
  const bool round = first.radius > 0.0 || second.radius > 0.0;
  result.may_turn = round && agrees(turned_place(first, second, found.normal), found, size);
  const bool follows = round && agrees(touching_place(first, second, found.normal), found, size);
  if (result.may_turn || follows) return;
  first = material(own, found.on_first, -found.normal, found.on_first);
  second = material(other, found.on_second, found.normal, found.on_first);
}

Rolled rolled(const RollingPoint& point, const ShapePlace& own, const ShapePlace& other,
              bool halved, bool on_world) {
  const TouchingFeature first = point.own.feature.moved(own.pose);
  const TouchingFeature second = point.other.feature.moved(other.pose);
  const Vector3 normal = point.frame.col(0);
  Rolled result;
  result.frame = point.frame;
  collision::TouchingPlace place = touching_place(first, second, normal);
  result.own_pressed = farthest_point(first, -normal);
  result.other_pressed = farthest_point(second, normal);
  const bool follows =
      point.turning != RollingPoint::Turning::fixed && follow(point, first, second, place);
  if (follows) result.frame = turned(point.frame, place.normal);
  const Vector3 own_lever = place.on_first - first.at;
  const Vector3 other_lever = place.on_second + place.gap * place.normal - second.at;
  Vector3 slip = travel(point.own, own, first.at, own_lever, halved);
  slip -= on_world && halved ? half_of_whole(point, other_lever)
                             : travel(point.other, other, second.at, other_lever, halved);
  const Matrix3 mean = halved ? result.frame : Matrix3(0.5 * (result.frame + point.frame));
  result.motion << place.gap, mean.col(1).dot(slip), mean.col(2).dot(slip);
  result.own_at = first.at + own_lever;
  result.other_at = second.at + other_lever;
  if (follows && point.turning == RollingPoint::Turning::mean) {
    result.own_at = first.at + 0.5 * (point.own.lever + own_lever);
    result.other_at = second.at + 0.5 * (point.other.lever + other_lever);
    result.frame = turned(point.frame, mean.col(0).normalized());
  }
  if (follows) {
    result.own_pressed = result.own_at;
    result.other_pressed = result.other_at;
  }
  return result;
}

}  // namespace sinew::constraint
