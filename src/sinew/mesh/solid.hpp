/// @file
/// Volume, centre and moments of the solid in a closed surface, for rigid bodies.
#pragma once

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Integrals over the interior of a closed surface.
struct SolidMoments {
  double volume = 0.0;               ///< m^3; negative if the triangles face inwards
  Vector3 centre = Vector3::Zero();  ///< (3,) m, centre of volume
  Matrix3 second = Matrix3::Zero();  ///< (3, 3) m^5, integral of (x - centre) (x - centre)^T
  /// (3, 3) m^5: the inertia tensor about the centre, divided by the density.
  Matrix3 inertia() const { return second.trace() * Matrix3::Identity() - second; }
};

/// Computes the moments, exact up to rounding, as sums over the signed tetrahedra between each
/// triangle and one common point. With corners v_0 = 0, v_1, v_2, v_3 and the volume V,
///   integral of x     = V / 4 sum v_i,
///   integral of x x^T = V / 20 (s s^T + sum v_i v_i^T),   s = sum v_i,
/// since the integral of lambda_i lambda_j is V (1 + delta_ij) / 20 (Strang & Fix, An Analysis of
/// the Finite Element Method, 1973; the same integrals: Mirtich, J. Graphics Tools 1, 1996).
/// @param surface closed. If the volume is 0, the centre is the mean of the nodes.
SolidMoments solid_moments(const Surface& surface);

/// Throws Error(self-crossing), with the place of the first fault, if triangles without a common
/// corner cross or touch. @param surface to check.
void require_no_crossing(const Surface& surface);

/// Throws Error unless the surface bounds a solid: surface-not-closed, zero-volume,
/// inverted-element (it faces inwards), self-crossing.
/// @param surface to check; may have several parts, and cavities whose surfaces face inwards.
void require_solid(const Surface& surface);

}  // namespace sinew::mesh
