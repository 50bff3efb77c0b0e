#include "sinew/constraint/surface.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::constraint {

namespace {

SurfaceDistance from_centre(const Vector3& centre, double radius, const Vector3& point) {
  const Vector3 out = point - centre;
  const double far = out.norm();
  return {far - radius, far > 0.0 ? Vector3(out / far) : Vector3::UnitZ()};
}

SurfaceDistance distance_to(const Plane& plane, const Vector3& point) {
  return {plane.normal.dot(point - plane.point), plane.normal};
}

SurfaceDistance distance_to(const Sphere& sphere, const Vector3& point) {
  return from_centre(sphere.centre, sphere.radius, point);
}

SurfaceDistance distance_to(const Capsule& capsule, const Vector3& point) {
  const Vector3 axis = capsule.to - capsule.from;
  const double length = axis.squaredNorm();
  const double along = length > 0.0 ? axis.dot(point - capsule.from) / length : 0.0;
  const Vector3 nearest = capsule.from + std::clamp(along, 0.0, 1.0) * axis;
  SurfaceDistance result = from_centre(nearest, capsule.radius, point);
  if (point == nearest && length > 0.0) result.normal = axis.unitOrthogonal();
  return result;
}

PrincipalFrame round_about(const Vector3& normal, double distance) {
  const double curvature = distance > 0.0 ? 1.0 / distance : 0.0;
  return {tangent_frame(normal), {0.0, curvature, curvature}};
}

PrincipalFrame principal_frame_of(const Plane& plane, const Vector3&) {
  return {tangent_frame(plane.normal), Vector3::Zero()};
}

PrincipalFrame principal_frame_of(const Sphere& sphere, const Vector3& point) {
  const SurfaceDistance from = distance_to(sphere, point);
  return round_about(from.normal, from.gap + sphere.radius);
}

PrincipalFrame principal_frame_of(const Capsule& capsule, const Vector3& point) {
  const SurfaceDistance from = distance_to(capsule, point);
  PrincipalFrame result = round_about(from.normal, from.gap + capsule.radius);
  const Vector3 axis = capsule.to - capsule.from;
  const double along = axis.dot(point - capsule.from);
  if (!(along > 0.0 && along < axis.squaredNorm())) return result;  // about an end
  const Vector3 side = axis.normalized();
  result.frame << from.normal, side, from.normal.cross(side);
  result.curvature[1] = 0.0;
  return result;
}

// Of the way's length: what counts as touching, and how near the least gap is found.
constexpr double kTouches = 1e-12;
constexpr int kMaxTries = 100;  // a way that grazes a surface halves its distance in each

// The gap along a way, at shares of it.
class GapOnWay {
 public:
  GapOnWay(const Surface& surface, const Vector3& from, const Vector3& to)
      : surface_(surface), from_(from), way_(to - from), touches_(kTouches * way_.norm()) {
    move(0.0);
  }
  void move(double share) {
    share_ = share;
    at_ = from_ + share * way_;
    here_ = distance(surface_, at_);
  }
  double share() const { return share_; }
  double slope() const { return here_.normal.dot(way_); }
  bool touches() const { return here_.gap <= touches_; }
  double next_zero() const { return share_ - here_.gap / slope(); }
  SurfaceApproach result(bool meets) const { return {at_, here_, meets}; }

 private:
  const Surface& surface_;
  Vector3 from_, way_, at_;
  double touches_, share_ = 0.0;
  SurfaceDistance here_;
};

// The least gap lies where its slope, which rises, passes zero.
SurfaceApproach nearest_between(GapOnWay& gap, double falling, double rising) {
  while (rising - falling > kTouches) {
    const double middle = 0.5 * (falling + rising);
    gap.move(middle);
    (gap.slope() < 0.0 ? falling : rising) = middle;
  }
  gap.move(rising);
  return gap.result(false);
}

void check_radius(double radius) {
  if (radius > 0.0 && std::isfinite(radius)) return;
  throw Error(ErrorKind::out_of_range, {}, fmt::format("the radius is {:g} m", radius),
              "give a positive length");
}

}  // namespace

SurfaceDistance distance(const Surface& surface, const Vector3& point) {
  return std::visit([&](const auto& shape) { return distance_to(shape, point); }, surface);
}

PrincipalFrame principal_frame(const Surface& surface, const Vector3& point) {
  return std::visit([&](const auto& one) { return principal_frame_of(one, point); }, surface);
}

SurfaceApproach approach(const Surface& surface, const Vector3& from, const Vector3& to) {
  GapOnWay gap(surface, from, to);
  if (!(gap.slope() < 0.0)) return gap.result(false);
  for (int k = 0; k < kMaxTries && !gap.touches(); ++k) {
    const double before = gap.share(), next = gap.next_zero();
    if (next - before <= kTouches) break;
    gap.move(std::min(next, 1.0));
    if (gap.slope() >= 0.0 && !gap.touches()) return nearest_between(gap, before, gap.share());
    if (next >= 1.0) return gap.result(false);
  }
  return gap.result(true);
}

Matrix3 tangent_frame(const Vector3& normal) {
  const double sign = std::copysign(1.0, normal[2]);
  const double a = -1.0 / (sign + normal[2]);
  const double b = normal[0] * normal[1] * a;
  Matrix3 frame;
  frame.col(0) = normal;
  frame.col(1) << 1.0 + sign * normal[0] * normal[0] * a, sign * b, -sign * normal[0];
  frame.col(2) << b, sign + normal[1] * normal[1] * a, -normal[1];
  return frame;
}

Surface checked(Surface surface) {
  if (auto* plane = std::get_if<Plane>(&surface)) {
    const double length = plane->normal.norm();
    if (!(length > 0.0) || !std::isfinite(length)) {
      throw Error(ErrorKind::out_of_range, {}, "the plane's normal has no length",
                  "give one such as 0 0 1, out of what is solid");
    }
    plane->normal /= length;
  } else if (const auto* sphere = std::get_if<Sphere>(&surface)) {
    check_radius(sphere->radius);
  } else if (const auto* capsule = std::get_if<Capsule>(&surface)) {
    check_radius(capsule->radius);
  }
  return surface;
}

}  // namespace sinew::constraint
