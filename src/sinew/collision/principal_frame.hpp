/// @file
/// Frames on the surfaces of shapes, and how they curve.
#pragma once

#include <variant>

#include "sinew/collision/shape.hpp"

namespace sinew::collision {

/// Normal and two tangents as columns, right-handed (Duff et al. 2017); continuous in the normal
/// but where its z changes sign.
/// @param normal (3,) unit length.
Matrix3 tangent_frame(const Vector3& normal);

/// Normal and two tangents, the eigenvectors of the gap's second derivative, and its eigenvalues.
struct PrincipalFrame {
  Matrix3 frame = Matrix3::Identity();  ///< columns: normal, tangents
  Vector3 curvature = Vector3::Zero();  ///< (3,) 1/m, >= 0, that along the normal zero
};
/// Of shapes without edges. With r the distance from the nearest point of the centre or the axis,
/// the gap curves by 1/r across the way from there: both tangents' for a ball, the one across the
/// axis beside a rod.
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
