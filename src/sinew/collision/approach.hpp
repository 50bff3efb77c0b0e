/// @file
/// Where a point on a straight path first meets a shape, or passes it.
#pragma once

#include <variant>

#include "sinew/collision/shape.hpp"

namespace sinew::collision {

/// Where a path first meets a shape, or, if it misses the shape, comes closest.
struct ShapeApproach {
  Vector3 at = Vector3::Zero();  ///< (3,) m, on the path
  ShapeDistance distance;        ///< of that point; if it meets, the gap is zero to rounding
  bool meets = false;            ///< false: the whole path lies outside
};
/// Finds where a straight path first meets a shape. Every shape is convex, so the gap is a convex
/// function along the path. Newton's method from the start of the path converges to the first zero
/// from the near side and never overshoots. If there is no zero, the gap rises, and its minimum
/// lies before that point. The tangent plane at the result has the start of the path on its outer
/// side, and, if the path misses the shape, the whole path.
/// @param plane the shape, checked().
/// @param from (3,) m, outside; a path that starts inside meets the shape there, unless it leads
///   out.
/// @param to (3,) m.
ShapeApproach approach(const Plane& plane, const Vector3& from, const Vector3& to);
ShapeApproach approach(const Sphere& sphere, const Vector3& from, const Vector3& to);
ShapeApproach approach(const Capsule& capsule, const Vector3& from, const Vector3& to);
ShapeApproach approach(const Cylinder& cylinder, const Vector3& from, const Vector3& to);
ShapeApproach approach(const OrientedBox& box, const Vector3& from, const Vector3& to);
ShapeApproach approach(const ConvexSolid& solid, const Vector3& from, const Vector3& to);
/// @param shape see distance(). @param from,to (3,) m, ends of the path.
template <class... Kinds>
ShapeApproach approach(const std::variant<Kinds...>& shape, const Vector3& from,
                       const Vector3& to) {
  return std::visit([&](const auto& own) { return approach(own, from, to); }, shape);
}

}  // namespace sinew::collision
