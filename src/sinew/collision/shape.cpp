#include "sinew/collision/shape.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/collision/closest_points.hpp"
#include "sinew/core/error.hpp"

namespace sinew::collision {

namespace {

// Sine of the inclination from which on a rim rolls about its axis. For a smaller inclination, the
// point where its normal meets the axis is farther away, and represents a tilting rim worse.
constexpr double kRim = 0.3;

ShapeDistance along(const Vector3& point, double gap, const Vector3& normal) {
  return {gap, point - gap * normal, normal};
}

ShapeDistance from_axis(const Vector3& axis_point, double radius, const Vector3& point,
                        const Vector3& otherwise) {
  const Vector3 out = point - axis_point;
  const double far = out.norm();
  return along(point, far - radius, far > 0.0 ? (out / far).eval() : otherwise);
}

// For a solid with perpendicular sides: the excess beyond each side, and the outward directions of
// the sides, as columns.
template <int N>
ShapeDistance over_sides(const Vector3& point, const Eigen::Matrix<double, N, 1>& excess,
                         const Eigen::Matrix<double, 3, N>& outward) {
  const Eigen::Matrix<double, N, 1> outside = excess.cwiseMax(0.0);
  const double far = outside.norm();
  if (far > 0.0) return along(point, far, (outward * outside / far).normalized());
  Eigen::Index nearest = 0;
  const double depth = excess.maxCoeff(&nearest);
  return along(point, depth, outward.col(nearest));
}

void check_size(double size, const char* what) {
  if (size > 0.0 && std::isfinite(size)) return;
  throw Error(ErrorKind::out_of_range, {}, fmt::format("the {} is {:g} m", what, size),
              "give a positive length");
}

void check_axes(const Matrix3& axes, const char* what) {
  const double skew = (axes.transpose() * axes - Matrix3::Identity()).norm();
  if (skew <= 1e-9) return;
  throw Error(ErrorKind::out_of_range, {},
              fmt::format("the {}'s axes are off a rotation by {:g}", what, skew),
              "give three orthogonal columns of unit length");
}

}  // namespace

ShapeDistance distance(const Plane& plane, const Vector3& point) {
  return along(point, plane.normal.dot(point - plane.point), plane.normal);
}

ShapeDistance distance(const Sphere& sphere, const Vector3& point) {
  return from_axis(sphere.centre, sphere.radius, point, Vector3::UnitZ());
}

ShapeDistance distance(const Capsule& capsule, const Vector3& point) {
  const Vector3 axis = capsule.to - capsule.from;
  const Vector3 nearest = closest_on_edge(point, capsule.from, capsule.to).point;
  return from_axis(nearest, capsule.radius, point,
                   axis.norm() > 0.0 ? axis.unitOrthogonal() : Vector3::UnitZ());
}

ShapeDistance distance(const Cylinder& cylinder, const Vector3& point) {
  const Vector3 whole = cylinder.to - cylinder.from;
  const double length = whole.norm();
  const Vector3 axis = whole / length;
  const Vector3 offset = point - 0.5 * (cylinder.from + cylinder.to);
  const double height = axis.dot(offset);
  const Vector3 across = offset - height * axis;
  const double far = across.norm();
  Eigen::Matrix<double, 3, 2> outward;
  outward << (far > 0.0 ? (across / far).eval() : axis.unitOrthogonal().eval()),
      std::copysign(1.0, height) * axis;
  return over_sides<2>(point, {far - cylinder.radius, std::abs(height) - 0.5 * length}, outward);
}

ShapeDistance distance(const OrientedBox& box, const Vector3& point) {
  const Vector3 local = box.axes.transpose() * (point - box.centre);
  const Vector3 side = local.unaryExpr([](double x) { return std::copysign(1.0, x); });
  return over_sides<3>(point, local.cwiseAbs() - box.half_size, box.axes * side.asDiagonal());
}

ShapeDistance distance(const ConvexSolid& solid, const Vector3& point) {
  constexpr double kNear = 1e-12;  // relative to the size: nearer points give no accurate normal
  const Vector3 local = solid.axes.transpose() * (point - solid.origin);
  const Polyhedron& hull = *solid.hull;
  double excess = -kInfinity, square = kInfinity;
  Vector3 normal = Vector3::UnitZ(), nearest = local;
  for (const Polyhedron::Face& face : hull.faces()) {
    const double above = face.normal.dot(local) - face.offset;
    if (above > excess) {
      excess = above;
      normal = face.normal;
    }
    if (!(above > 0.0) || above * above >= square) continue;
    const auto& [a, b, c] = face.corners;
    const Vector3 on = closest_on_triangle(local, a, b, c).point;
    if (!((local - on).squaredNorm() < square)) continue;
    square = (local - on).squaredNorm();
    nearest = on;
  }
  const double far = std::sqrt(square);
  const bool outside = excess > 0.0 && far > kNear * hull.reach();
  if (!outside) return along(point, excess, solid.axes * normal);
  return along(point, far, (solid.axes * (local - nearest)).normalized());
}

Shape moved(const Shape& shape, const Eigen::Isometry3d& pose) {
  Shape result = shape;
  if (auto* plane = std::get_if<Plane>(&result)) {
    plane->point = pose * plane->point;
    plane->normal = pose.linear() * plane->normal;
  } else if (auto* sphere = std::get_if<Sphere>(&result)) {
    sphere->centre = pose * sphere->centre;
  } else if (auto* capsule = std::get_if<Capsule>(&result)) {
    capsule->from = pose * capsule->from;
    capsule->to = pose * capsule->to;
  } else if (auto* cylinder = std::get_if<Cylinder>(&result)) {
    cylinder->from = pose * cylinder->from;
    cylinder->to = pose * cylinder->to;
  } else if (auto* box = std::get_if<OrientedBox>(&result)) {
    box->centre = pose * box->centre;
    box->axes = pose.linear() * box->axes;
  } else if (auto* solid = std::get_if<ConvexSolid>(&result)) {
    solid->origin = pose * solid->origin;
    solid->axes = pose.linear() * solid->axes;
  }
  return result;
}

double rounding_radius(const Shape& shape, const Vector3& normal) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return capsule->radius;
  const auto* cylinder = std::get_if<Cylinder>(&shape);
  if (cylinder == nullptr) return 0.0;
  const double lean = normal.dot((cylinder->to - cylinder->from).normalized());
  const double across = std::sqrt(std::max(0.0, 1.0 - lean * lean));
  return across >= kRim ? cylinder->radius / across : 0.0;
}

Plane checked(Plane plane) {
  const double length = plane.normal.norm();
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw Error(ErrorKind::out_of_range, {}, "the plane's normal has no length",
                "give one such as 0 0 1, out of what is solid");
  }
  plane.normal /= length;
  return plane;
}

Sphere checked(Sphere sphere) {
  check_size(sphere.radius, "radius");
  return sphere;
}

Capsule checked(Capsule capsule) {
  check_size(capsule.radius, "radius");
  return capsule;
}

Cylinder checked(Cylinder cylinder) {
  check_size(cylinder.radius, "radius");
  check_size((cylinder.to - cylinder.from).norm(), "cylinder's length");
  return cylinder;
}

OrientedBox checked(OrientedBox box) {
  for (const double size : box.half_size) check_size(size, "box's half size");
  check_axes(box.axes, "box");
  return box;
}

ConvexSolid checked(ConvexSolid solid) {
  if (solid.hull == nullptr) {
    throw Error(ErrorKind::zero_volume, {}, "the convex solid has no hull", "give it one");
  }
  check_axes(solid.axes, "solid");
  return solid;
}

}  // namespace sinew::collision
