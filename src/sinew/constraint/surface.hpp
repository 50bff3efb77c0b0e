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

/// Where a point that moves straight on first meets a surface, or, if it misses it, comes nearest.
struct SurfaceApproach {
  Vector3 at = Vector3::Zero();  ///< (3,) m, on the way
  SurfaceDistance distance;      ///< there; the gap of a meeting is zero but for rounding
  bool meets = false;            ///< false: the whole way lies outside
};
/// Every surface here bounds a convex solid, and so the gap along the way is a convex function of
/// it: Newton's method from the beginning finds its first zero from the near side, never beyond,
/// and a zero that does not exist shows in a rising gap, before which the least gap lies.
/// The tangent plane at the result has the way's beginning on its outer side, and where the way
/// misses the surface, all of it.
/// @param surface see Surface. @param from (3,) m, outside; a way that begins inside meets the
///   surface there, unless it leads out. @param to (3,) m.
SurfaceApproach approach(const Surface& surface, const Vector3& from, const Vector3& to);

/// Normal and two tangents as columns, right-handed (Duff et al. 2017); continuous in the normal
/// but where its z changes sign.
/// @param normal (3,) unit length.
Matrix3 tangent_frame(const Vector3& normal);

/// Normal and two tangents, the eigenvectors of the gap's second derivative, and its eigenvalues.
struct PrincipalFrame {
  Matrix3 frame = Matrix3::Identity();  ///< columns: normal, tangents
  Vector3 curvature = Vector3::Zero();  ///< (3,) 1/m, >= 0, that along the normal zero
};
/// With r the distance from the nearest point of the centre or the axis, the gap curves by 1/r
/// across the way from there: both tangents' for a ball, the one across the axis beside a rod.
/// @param surface see Surface. @param point (3,) m.
PrincipalFrame principal_frame(const Surface& surface, const Vector3& point);

/// Throws Error(out-of-range) for a radius that is not positive and a normal without length; else
/// the surface with its normal of unit length.
Surface checked(Surface surface);

}  // namespace sinew::constraint
