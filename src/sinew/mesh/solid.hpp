/// @file
/// What a closed surface encloses, as far as the motion of a rigid body depends on it.
#pragma once

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Integrals over the inside of a closed surface.
struct SolidMoments {
  double volume = 0.0;               ///< m^3; negative where the triangles face inwards
  Vector3 centre = Vector3::Zero();  ///< (3,) m, of volume
  Matrix3 second = Matrix3::Zero();  ///< (3, 3) m^5: of (x - centre) (x - centre)^T
  /// m^5, about the centre: times a density, the tensor of inertia.
  Matrix3 inertia() const { return second.trace() * Matrix3::Identity() - second; }
};

/// Exact but for rounding: sums over the tetrahedra that the triangles span with one point, each
/// with the sign of its orientation. With corners v_0 = 0, v_1, v_2, v_3 and the volume V,
///   integral of x     = V / 4 sum v_i,
///   integral of x x^T = V / 20 (s s^T + sum v_i v_i^T),   s = sum v_i,
/// since the integral of lambda_i lambda_j is V (1 + delta_ij) / 20 (Strang & Fix, An Analysis of
/// the Finite Element Method, 1973; the same integrals: Mirtich, J. Graphics Tools 1, 1996).
/// @param surface closed. A volume of 0 has its centre at the mean of the nodes.
SolidMoments solid_moments(const Surface& surface);

/// Throws Error(self-crossing) where triangles that share no corner cross or touch each other;
/// names the place of the first. @param surface to check.
void require_no_crossing(const Surface& surface);

/// Throws Error unless the surface is the outside of a solid: surface-not-closed, inverted-element
/// (it faces inwards), zero-volume, self-crossing. Names the place of the first fault.
/// @param surface to check; may have several parts, and hollows that face into themselves.
void require_solid(const Surface& surface);

}  // namespace sinew::mesh
