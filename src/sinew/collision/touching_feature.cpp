#include "sinew/collision/touching_feature.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sinew::collision {

namespace {

using Kind = TouchingFeature::Kind;

// Relative to a size: a point is at an end, on an edge or a corner.
constexpr double kAtEnd = 1e-9;
// Sine of the angle between lines below which their crossing is not a point.
constexpr double kParallel = 0.05;

double share_along(const Vector3& from, const Vector3& to, const Vector3& point) {
  return (point - from).dot(to - from) / (to - from).squaredNorm();
}

bool is_between(double share) { return share > kAtEnd && share < 1.0 - kAtEnd; }

TouchingFeature feature(const Plane& plane, const Vector3& on, const Vector3&) {
  return {Kind::face, on, plane.normal, 0.0};
}

TouchingFeature feature(const Sphere& sphere, const Vector3&, const Vector3&) {
  return {Kind::point, sphere.centre, Vector3::Zero(), sphere.radius};
}

TouchingFeature feature(const Capsule& capsule, const Vector3& on, const Vector3& outward) {
  const Vector3 along = capsule.to - capsule.from, core = on - capsule.radius * outward;
  const double share = along.isZero(0.0) ? 0.0 : share_along(capsule.from, capsule.to, core);
  if (is_between(share)) {
    return {Kind::line, capsule.from + share * along, along.normalized(), capsule.radius};
  }
  return {Kind::point, share < 0.5 ? capsule.from : capsule.to, Vector3::Zero(), capsule.radius};
}

TouchingFeature feature(const Cylinder& cylinder, const Vector3& on, const Vector3& outward) {
  const Vector3 along = cylinder.to - cylinder.from;
  const double upright = outward.dot(along.normalized());
  if (std::abs(upright) > 1.0 - kAtEnd) {
    return {Kind::face, on, std::copysign(1.0, upright) * along.normalized(), 0.0};
  }
  if (rounding_radius(cylinder, outward) == 0.0) return {Kind::point, on, Vector3::Zero(), 0.0};
  const double share = share_along(cylinder.from, cylinder.to, on);
  const Kind kind = is_between(share) ? Kind::line : Kind::circle;
  return {kind, cylinder.from + std::clamp(share, 0.0, 1.0) * along, along.normalized(),
          cylinder.radius};
}

TouchingFeature feature(const OrientedBox& box, const Vector3& on, const Vector3&) {
  const Vector3 local = box.axes.transpose() * (on - box.centre);
  int sides = 0, last = 0, free = 0;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(local[k]) >= (1.0 - kAtEnd) * box.half_size[k]) {
      ++sides;
      last = k;
    } else {
      free = k;
    }
  }
  if (sides == 2) return {Kind::line, on, box.axes.col(free), 0.0};
  if (sides != 1) return {Kind::point, on, Vector3::Zero(), 0.0};
  return {Kind::face, on, std::copysign(1.0, local[last]) * box.axes.col(last), 0.0};
}

TouchingFeature feature(const ConvexSolid&, const Vector3& on, const Vector3&) {
  return {Kind::point, on, Vector3::Zero(), 0.0};
}

void slide_to(TouchingFeature& line, const Vector3& point) {
  line.at += line.axis.dot(point - line.at) * line.axis;
}

// Moves the points of two lines along them to their crossing.
void cross(TouchingFeature& first, TouchingFeature& second) {
  const Vector3 between = first.at - second.at;
  const double along = first.axis.dot(second.axis), sine = 1.0 - along * along;
  const double one = first.axis.dot(between), other = second.axis.dot(between);
  first.at += (along * other - one) / sine * first.axis;
  second.at += (other - along * one) / sine * second.axis;
}

// The normal of two features without a face, whose points on lines slide to the nearest places.
std::optional<Vector3> normal_between(TouchingFeature& first, TouchingFeature& second) {
  if (first.kind == Kind::circle || second.kind == Kind::circle) return std::nullopt;
  const bool both = first.kind == Kind::line && second.kind == Kind::line;
  const Vector3 crossed = both ? Vector3(first.axis.cross(second.axis)) : Vector3(Vector3::Zero());
  if (crossed.norm() > kParallel) {
    cross(first, second);
    return crossed.normalized();
  }
  if (first.radius == 0.0 && second.radius == 0.0) return std::nullopt;
  if (second.kind == Kind::line) {
    slide_to(second, first.at);
  } else if (first.kind == Kind::line) {
    slide_to(first, second.at);
  }
  const Vector3 between = first.at - second.at;
  if (between.isZero(0.0)) return std::nullopt;
  return between.normalized();
}

}  // namespace

TouchingFeature TouchingFeature::moved(const Eigen::Isometry3d& pose) const {
  return {kind, pose * at, pose.linear() * axis, radius};
}

TouchingFeature touching_feature(const Shape& shape, const Vector3& on, const Vector3& outward) {
  return std::visit([&](const auto& own) { return feature(own, on, outward); }, shape);
}

Vector3 farthest_point(const TouchingFeature& feature, const Vector3& direction) {
  if (feature.radius == 0.0) return feature.at;
  if (feature.kind != Kind::circle) return feature.at + feature.radius * direction;
  const Vector3 across = direction - direction.dot(feature.axis) * feature.axis;
  const double length = across.norm();
  return length > 0.0 ? Vector3(feature.at + feature.radius / length * across) : feature.at;
}

TouchingPlace touching_place(const TouchingFeature& first, const TouchingFeature& second,
                             const Vector3& normal) {
  TouchingPlace place{farthest_point(first, -normal), farthest_point(second, normal), normal, 0.0};
  place.gap = normal.dot(place.on_first - place.on_second);
  if (first.kind == Kind::face && second.kind != Kind::face) {
    place.on_first = place.on_second + place.gap * normal;
  } else if (second.kind == Kind::face) {
    place.on_second = place.on_first - place.gap * normal;
  }
  return place;
}

TouchingPlace turned_place(const TouchingFeature& first, const TouchingFeature& second,
                           const Vector3& near) {
  if (second.kind == Kind::face) return touching_place(first, second, second.axis);
  if (first.kind == Kind::face) return touching_place(first, second, -first.axis);
  TouchingFeature one = first, other = second;
  const auto normal = normal_between(one, other);
  if (!normal) return touching_place(first, second, near);
  return touching_place(one, other, normal->dot(near) < 0.0 ? Vector3(-*normal) : *normal);
}

}  // namespace sinew::collision
