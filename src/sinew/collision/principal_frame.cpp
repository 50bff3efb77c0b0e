#include "sinew/collision/principal_frame.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace sinew::collision {

namespace {

PrincipalFrame round_about(const Vector3& normal, double distance) {
  const double curvature = distance > 0.0 ? 1.0 / distance : 0.0;
  return {tangent_frame(normal), {0.0, curvature, curvature}};
}

}  // namespace

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

PrincipalFrame principal_frame(const Plane& plane, const Vector3&) {
  return {tangent_frame(plane.normal), Vector3::Zero()};
}

PrincipalFrame principal_frame(const Sphere& sphere, const Vector3& point) {
  const ShapeDistance from = distance(sphere, point);
  return round_about(from.normal, from.gap + sphere.radius);
}

PrincipalFrame principal_frame(const Capsule& capsule, const Vector3& point) {
  const ShapeDistance from = distance(capsule, point);
  PrincipalFrame result = round_about(from.normal, from.gap + capsule.radius);
  const Vector3 axis = capsule.to - capsule.from;
  const double along = axis.dot(point - capsule.from);
  if (!(along > 0.0 && along < axis.squaredNorm())) return result;  // about an end
  const Vector3 side = axis.normalized();
  result.frame << from.normal, side, from.normal.cross(side);
  result.curvature[1] = 0.0;
  return result;
}

}  // namespace sinew::collision
