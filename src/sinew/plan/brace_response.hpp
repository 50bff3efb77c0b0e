/// @file
/// How an arm at rest, with one of its points stuck to an object, answers a force on its tip.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::plan {

/// M dq'' + D dq' + K dq = J^T df + J_t^T phi with J dq = 0: small motions dq about an equilibrium
/// whose held point, of Jacobian J, does not move, under a force phi on the tip.
struct HeldEquilibrium {
  using Jacobian = Eigen::Matrix<double, 3, Eigen::Dynamic>;
  MatrixX stiffness;  ///< K (n, n), second derivative of the potential with the held point's force
  MatrixX damping;    ///< D (n, n)
  MatrixX mass;       ///< M (n, n)
  Jacobian held;      ///< J (3, n); no columns: nothing is held
  Jacobian tip;       ///< J_t (3, n)
};

struct TipResponse {
  bool stable = false;           ///< Z^T K Z is positive definite; what follows is of stable ones
  int mobility = 0;              ///< directions in which the tip still moves
  double compliance = 0.0;       ///< m/N, the largest at rest
  double peak_compliance = 0.0;  ///< m/N, the largest of all frequencies
  /// N/N: what friction must hold, |f_t| + gain |phi| <= mu F_n, for a force phi on the tip.
  double friction_gain = 0.0;
};

/// With phi = Re(a exp(i w t)), A = K + i w D - w^2 M and Z a basis of the null space of J:
///   dq = Z (Z^T A Z)^-1 Z^T J_t^T a,   df = (J^T)^+ (A dq - J_t^T a) = G a.
/// The point sticks while u . (f_t + df) <= mu n . (f + df) for every unit u across the normal n
/// (Coulomb's cone: Murray, Li & Sastry 1994, sec. 5.2; forces of constraints: sec. 6.1), so as
/// long as
///   |f_t| + gain |a| <= mu F_n,   gain = max over u and w of |(u - mu n)^T G|,
/// and by the triangle inequality under sums of sines whose amplitudes add up to |a|.
/// @param of which. @param frequency Hz, >= 0: of all from zero to this. @param normal unit length;
/// without a held point any. @param friction mu, >= 0.
TipResponse tip_response(const HeldEquilibrium& of, double frequency, const Vector3& normal,
                         double friction);

}  // namespace sinew::plan
