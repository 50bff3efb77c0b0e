#include "sinew/collision/symmetric_solid.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "sinew/core/error.hpp"

namespace sinew::collision {

namespace {

Matrix3 frame_along(const Vector3& axis) {
  Matrix3 axes;
  axes.col(2) = axis;
  axes.col(0) = axis.unitOrthogonal();
  axes.col(1) = axis.cross(axes.col(0));
  return axes;
}

SymmetricSolid about_segment(const Vector3& from, const Vector3& to) {
  const double length = (to - from).norm();
  SymmetricSolid solid{.centre = 0.5 * (from + to)};
  if (!(length > 0.0)) return solid;
  solid.axes = frame_along((to - from) / length);
  solid.half_size[2] = 0.5 * length;
  return solid;
}

SymmetricSolid as_solid(const Plane&) {
  throw Error(ErrorKind::internal, {}, "a plane has no end");
}

SymmetricSolid as_solid(const Sphere& sphere) {
  return {.centre = sphere.centre, .radius = sphere.radius};
}

SymmetricSolid as_solid(const Capsule& capsule) {
  SymmetricSolid solid = about_segment(capsule.from, capsule.to);
  solid.radius = capsule.radius;
  return solid;
}

SymmetricSolid as_solid(const Cylinder& cylinder) {
  SymmetricSolid solid = about_segment(cylinder.from, cylinder.to);
  solid.rim = cylinder.radius;
  return solid;
}

SymmetricSolid as_solid(const OrientedBox& box) {
  return {.centre = box.centre, .axes = box.axes, .half_size = box.half_size};
}

SymmetricSolid as_solid(const ConvexSolid&) {
  throw Error(ErrorKind::not_in_this_version, {},
              "contact of a convex hull with another rigid shape but a plane",
              "give one of the bodies `points` that touch");
}

}  // namespace

double SymmetricSolid::extent(const Vector3& direction) const {
  const Vector3 local = axes.transpose() * direction;
  return local.cwiseAbs().dot(half_size) + rim * std::hypot(local[0], local[1]) + radius;
}

Vector3 SymmetricSolid::core_support(const Vector3& direction) const {
  const Vector3 local = axes.transpose() * direction;
  Vector3 point =
      half_size.binaryExpr(local, [](double h, double d) { return std::copysign(h, d); });
  const double across = std::hypot(local[0], local[1]);
  if (rim > 0.0 && across > 0.0) point.head<2>() += rim / across * local.head<2>();
  return centre + axes * point;
}

SymmetricSolid symmetric_solid(const Shape& shape) {
  return std::visit([](const auto& own) { return as_solid(own); }, shape);
}

}  // namespace sinew::collision
