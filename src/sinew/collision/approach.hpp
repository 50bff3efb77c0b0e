/// @file
/// Where a point that moves straight on first meets a shape, or passes it.
#pragma once

#include <variant>

#include "sinew/collision/shape.hpp"

namespace sinew::collision {

/// Where a way first meets a shape, or, if it misses it, comes nearest.
struct ShapeApproach {
  Vector3 at = Vector3::Zero();  ///< (3,) m, on the way
  ShapeDistance distance;        ///< there; the gap of a meeting is zero but for rounding
  bool meets = false;            ///< false: the whole way lies outside
};
/// Every shape is convex, and so the gap along the way is a convex function of it: Newton's method
/// from the beginning finds its first zero from the near side, never beyond, and a zero that does
/// not exist shows in a rising gap, before which the least gap lies. The tangent plane at the
/// result has the way's beginning on its outer side, and where the way misses the shape, all of it.
/// @param plane the shape, checked().
/// @param from (3,) m, outside; a way that begins inside meets the shape there, unless it leads
///   out. @param to (3,) m.
ShapeApproach approach(const Plane& plane, const Vector3& from, const Vector3& to);
ShapeApproach approach(const Sphere& sphere, const Vector3& from, const Vector3& to);
ShapeApproach approach(const Capsule& capsule, const Vector3& from, const Vector3& to);
ShapeApproach approach(const Cylinder& cylinder, const Vector3& from, const Vector3& to);
ShapeApproach approach(const OrientedBox& box, const Vector3& from, const Vector3& to);
ShapeApproach approach(const ConvexSolid& solid, const Vector3& from, const Vector3& to);
/// @param shape see distance(). @param from,to (3,) m, ends of the way.
template <class... Kinds>
ShapeApproach approach(const std::variant<Kinds...>& shape, const Vector3& from,
                       const Vector3& to) {
  return std::visit([&](const auto& own) { return approach(own, from, to); }, shape);
}

}  // namespace sinew::collision
