/// @file
/// Response of an arm at rest, with one point stuck to an object, to a force on its tip.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::plan {

/// Linearisation M dq'' + D dq' + K dq = J^T df + J_t^T phi, J dq = 0, about an equilibrium: the
/// small motions dq under a force phi on the tip, while the held point, with Jacobian J, is fixed.
struct HeldEquilibrium {
  using Jacobian = Eigen::Matrix<double, 3, Eigen::Dynamic>;
  MatrixX stiffness;  ///< K (n, n), Hessian of the potential, with the force on the held point
  MatrixX damping;    ///< D (n, n)
  MatrixX mass;       ///< M (n, n)
  Jacobian held;      ///< J (3, n); no columns: no point is held
  Jacobian tip;       ///< J_t (3, n)
};

/// The result of tip_response(). The other members are valid only if `stable`.
struct TipResponse {
  bool stable = false;           ///< whether Z^T K Z is positive definite
  int mobility = 0;              ///< number of directions in which the tip can move
  double compliance = 0.0;       ///< m/N, largest static compliance
  double peak_compliance = 0.0;  ///< m/N, largest over all frequencies
  /// Friction gain, N/N: the point sticks if |f_t| + gain |phi| <= mu F_n, phi the force on the
  /// tip.
  double friction_gain = 0.0;
};

/// Computes compliance and friction gain. With phi = Re(a exp(i w t)), A = K + i w D - w^2 M and a
/// basis Z of the null space of J,
///   dq = Z (Z^T A Z)^-1 Z^T J_t^T a,   df = (J^T)^+ (A dq - J_t^T a) = G a.
/// The point sticks while u . (f_t + df) <= mu n . (f + df) for every unit vector u perpendicular
/// to the normal n (Coulomb cone: Murray, Li & Sastry 1994, sec. 5.2; constraint forces: sec. 6.1).
/// Hence it sticks if
///   |f_t| + gain |a| <= mu F_n,   gain = max over u and w of |(u - mu n)^T G|,
/// and by the triangle inequality also under sums of sines whose amplitudes add up to |a|.
/// @param of the equilibrium. @param frequency Hz, >= 0: upper end of the range from zero.
/// @param normal unit length; any value if no point is held. @param friction mu, >= 0.
TipResponse tip_response(const HeldEquilibrium& of, double frequency, const Vector3& normal,
                         double friction);

}  // namespace sinew::plan
