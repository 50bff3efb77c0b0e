/// @file
/// Analytic rigid shapes: signed distance, nearest point and normal.
#pragma once

#include <memory>
#include <variant>

#include <Eigen/Geometry>

#include "sinew/collision/polyhedron.hpp"
#include "sinew/core/types.hpp"

namespace sinew::collision {

/// A half space, empty on the side that the normal points to.
struct Plane {
  Vector3 point = Vector3::Zero();    ///< (3,) m, on the plane
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, out of the solid side
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
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();  ///< (3,) m, centres of the ends, distinct
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
  Vector3 origin = Vector3::Zero();        ///< (3,) m, origin of that frame
  Matrix3 axes = Matrix3::Identity();      ///< (3, 3) columns: axes of that frame
};
using Shape = std::variant<Plane, Sphere, Capsule, Cylinder, OrientedBox, ConvexSolid>;

/// Position of a point relative to a shape: point = nearest + gap normal.
struct ShapeDistance {
  double gap = 0.0;                   ///< m, negative inside
  Vector3 nearest = Vector3::Zero();  ///< (3,) m, on the shape's surface
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, the gradient of the gap
};
/// Signed distance from a shape, exact to rounding. If several points are nearest (at centres,
/// axes, middle planes, the inner side of corners), one of them is returned.
/// @param plane the shape, checked(). @param point (3,) m.
ShapeDistance distance(const Plane& plane, const Vector3& point);
ShapeDistance distance(const Sphere& sphere, const Vector3& point);
ShapeDistance distance(const Capsule& capsule, const Vector3& point);
ShapeDistance distance(const Cylinder& cylinder, const Vector3& point);
ShapeDistance distance(const OrientedBox& box, const Vector3& point);
/// Inside, the distance is that of the nearest face plane; outside, that of the nearest of the
/// faces that the point sees (all of them are tried).
ShapeDistance distance(const ConvexSolid& solid, const Vector3& point);
/// @param shape Shape, or a variant of some of its kinds. @param point (3,) m.
template <class... Kinds>
ShapeDistance distance(const std::variant<Kinds...>& shape, const Vector3& point) {
  return std::visit([&](const auto& own) { return distance(own, point); }, shape);
}

/// The shape, moved by a pose. @param shape of any kind.
/// @param pose a rotation and a translation.
Shape moved(const Shape& shape, const Eigen::Isometry3d& pose);

/// Depth of the centre of curvature below the surface, m, along the normal: the radius of a sphere
/// or capsule; on the side and the rims of a cylinder, whose normals all meet its axis, the
/// distance to the axis; 0 on flat parts, and on a rim that leans by less than 17 degrees. A body
/// that turns about such a centre, or about the axis through it, keeps its gaps along the normal.
/// @param shape of any kind.
/// @param normal (3,) unit length, of the surface, out of the shape or into it.
double rounding_radius(const Shape& shape, const Vector3& normal);

/// Checks a shape and returns it with a normal of unit length. Throws Error: out-of-range for sizes
/// that are not positive, a normal without length, and axes that are not orthonormal (to 1e-9).
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
