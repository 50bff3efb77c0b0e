/// @file
/// Frames on the surfaces of shapes, and their curvatures.
#pragma once

#include <variant>

#include "sinew/collision/shape.hpp"

namespace sinew::collision {

/// Right-handed frame of a normal and two tangents, as columns (Duff et al. 2017). It is a
/// continuous function of the normal except where z of the normal changes sign.
/// @param normal (3,) unit length.
Matrix3 tangent_frame(const Vector3& normal);

/// The eigenvectors of the gap's second derivative, normal first, and its eigenvalues.
struct PrincipalFrame {
  Matrix3 frame = Matrix3::Identity();  ///< columns: normal, tangents
  Vector3 curvature = Vector3::Zero();  ///< (3,) 1/m, >= 0; zero along the normal
};
/// Principal frame of a shape without edges. With r the distance from the nearest point of the
/// centre or axis, the gap has the curvature 1/r normal to the direction from there: in both
/// tangents for a sphere, and in the one across the axis for the side of a capsule.
/// @param plane the shape, checked(). @param point (3,) m.
PrincipalFrame principal_frame(const Plane& plane, const Vector3& point);
PrincipalFrame principal_frame(const Sphere& sphere, const Vector3& point);
PrincipalFrame principal_frame(const Capsule& capsule, const Vector3& point);
/// @param shape see distance(). @param point (3,) m.
template <class... Kinds>
PrincipalFrame principal_frame(const std::variant<Kinds...>& shape, const Vector3& point) {
  return std::visit([&](const auto& own) { return principal_frame(own, point); }, shape);
}

}  // namespace sinew::collision
