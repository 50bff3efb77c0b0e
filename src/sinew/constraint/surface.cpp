#include "sinew/constraint/surface.hpp"

#include <algorithm>
#include <cmath>

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

void check_radius(double radius) {
  if (radius > 0.0 && std::isfinite(radius)) return;
  throw Error(ErrorKind::out_of_range, {}, fmt::format("the radius is {:g} m", radius),
              "give a positive length");
}

}  // namespace

SurfaceDistance distance(const Surface& surface, const Vector3& point) {
  return std::visit([&](const auto& shape) { return distance_to(shape, point); }, surface);
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
