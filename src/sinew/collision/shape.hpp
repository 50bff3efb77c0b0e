/// @file
/// Rigid shapes in closed form: signed distance, nearest point and normal.
#pragma once

#include <memory>
#include <variant>

#include <Eigen/Geometry>

#include "sinew/collision/polyhedron.hpp"
#include "sinew/core/types.hpp"

namespace sinew::collision {

/// A half space, empty on the side that the normal points to.
struct Plane {
  Vector3 point = Vector3::Zero();    ///< (3,) m, on it
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, out of what is solid
};
/// A solid ball.
struct Sphere {
  Vector3 centre = Vector3::Zero();  ///< (3,) m
  double radius = 0.0;               ///< m, > 0
};
/// All points within a radius of a segment.
struct Capsule {
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();  ///< (3,) m
  double radius = 0.0;                                   ///< m, > 0
};
/// A solid cylinder with flat ends.
struct Cylinder {
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();  ///< (3,) m, the ends' centres; apart
  double radius = 0.0;                                   ///< m, > 0
};
/// A solid box.
struct OrientedBox {
  Vector3 centre = Vector3::Zero();            ///< (3,) m
  Matrix3 axes = Matrix3::Identity();          ///< (3, 3) columns: directions of its sides
  Vector3 half_size = Vector3::Constant(0.5);  ///< (3,) m, > 0
};
/// A solid convex polyhedron.
struct ConvexSolid {
  std::shared_ptr<const Polyhedron> hull;  ///< in its own frame
  Vector3 origin = Vector3::Zero();        ///< (3,) m, of that frame
  Matrix3 axes = Matrix3::Identity();      ///< (3, 3) columns: its axes
};
using Shape = std::variant<Plane, Sphere, Capsule, Cylinder, OrientedBox, ConvexSolid>;

/// Where a point stands with respect to a shape: point = nearest + gap normal.
struct ShapeDistance {
  double gap = 0.0;                   ///< m, negative inside
  Vector3 nearest = Vector3::Zero();  ///< (3,) m, on the shape's surface
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, the gradient of the gap
};
/// Exact but for rounding. Where several points are nearest (centres, axes, middle planes, the
/// inner side of corners), one of them is taken.
/// @param plane the shape, checked(). @param point (3,) m.
ShapeDistance distance(const Plane& plane, const Vector3& point);
ShapeDistance distance(const Sphere& sphere, const Vector3& point);
ShapeDistance distance(const Capsule& capsule, const Vector3& point);
ShapeDistance distance(const Cylinder& cylinder, const Vector3& point);
ShapeDistance distance(const OrientedBox& box, const Vector3& point);
/// Inside, the nearest face's plane is as far as the surface; outside, the nearest of the faces
/// that the point sees (all of them, in turn).
ShapeDistance distance(const ConvexSolid& solid, const Vector3& point);
/// @param shape Shape, or a variant of some of its kinds. @param point (3,) m.
template <class... Kinds>
ShapeDistance distance(const std::variant<Kinds...>& shape, const Vector3& point) {
  return std::visit([&](const auto& own) { return distance(own, point); }, shape);
}

/// The shape where a pose takes it. @param shape of any kind.
/// @param pose a rotation and a translation.
Shape moved(const Shape& shape, const Eigen::Isometry3d& pose);

/// How far below its surface the centres of a shape's roundness lie, m, along the normal: a
/// sphere's or capsule's radius; of a cylinder, whose normals all meet its axis, the way to there,
/// on its side and on its rims; 0 on what is flat, and on a rim that leans by less than 17 degrees.
/// A body that turns about such a centre, or about the axis through it, keeps its gaps along the
/// normal.
/// @param shape of any kind.
/// @param normal (3,) unit length, of the surface, out of the shape or into it.
double rounding_radius(const Shape& shape, const Vector3& normal);

/// Throws Error(out-of-range) for sizes that are not positive, a normal without length and axes
/// that are no rotation (to 1e-9); else the shape with its normal of unit length.
Plane checked(Plane plane);
Sphere checked(Sphere sphere);
Capsule checked(Capsule capsule);
Cylinder checked(Cylinder cylinder);
OrientedBox checked(OrientedBox box);
ConvexSolid checked(ConvexSolid solid);
/// @param shape see distance().
template <class... Kinds>
std::variant<Kinds...> checked(std::variant<Kinds...> shape) {
  std::visit([](auto& own) { own = checked(own); }, shape);
  return shape;
}

}  // namespace sinew::collision
