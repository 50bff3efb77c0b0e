/// @file
/// Analytic surfaces that material points may touch: signed distance and outward normal.
#pragma once

#include <variant>

#include "sinew/core/types.hpp"

namespace sinew::constraint {

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
using Surface = std::variant<Plane, Sphere, Capsule>;

/// Where a point stands with respect to a surface.
struct SurfaceDistance {
  double gap = 0.0;                   ///< m, negative inside
  Vector3 normal = Vector3::UnitZ();  ///< (3,) gradient of the gap, unit length
};
/// @param surface see Surface. @param point (3,) m. On the centre of a sphere or the axis of a
///   capsule, where the gap has no gradient, the normal is any one.
SurfaceDistance distance(const Surface& surface, const Vector3& point);

/// Normal and two tangents as columns, right-handed (Duff et al. 2017); continuous in the normal
/// but where its z changes sign.
/// @param normal (3,) unit length.
Matrix3 tangent_frame(const Vector3& normal);

/// Throws Error(out-of-range) for a radius that is not positive and a normal without length; else
/// the surface with its normal of unit length.
Surface checked(Surface surface);

}  // namespace sinew::constraint
