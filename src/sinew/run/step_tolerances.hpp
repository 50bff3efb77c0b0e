/// @file
/// Tolerances on the equation and the law of a step.
#pragma once

#include <algorithm>
#include <limits>

namespace sinew::run {

/// Bounds on the error that an iteration may leave to the next step, although the residual exceeds
/// the tolerance. After a full iteration with the exact derivative, the remaining motion is of
/// second order: about the last motion times the relative residual.
struct Lag {
  double residual = 0.0;  ///< relative residual; 0: no error may be left
  double move = 0.0;      ///< largest move times relative residual, relative to the robot's size
};
/// Of Equilibrium::following.
inline constexpr Lag kLag{0.1, 1e-3};
/// Tolerance on commanded motions, relative to the robot's size.
inline constexpr double kMotionTolerance = 1e-5;

/// Bound of the distance to the solution x* after an iteration moved by m to x, m. With the same
/// matrix A, the next iteration would move by c = |A^-1 r(x)|: the simplified Newton method. Its
/// errors satisfy e <- (I - A^-1 K) e, and the affine covariant Lipschitz condition gives
///   |I - A^-1 K| <= omega m = h,   c <= h/2 m   (one Newton step),
///   |x - x*| <= c/(1 - h) = c/(1 - 2 c/m)
/// (P. Deuflhard, Newton Methods for Nonlinear Problems (2004), theorem 2.5 and section 2.1.2, with
/// h estimated by 2 c/m). The norm is the largest change of a coordinate, in which h may be
/// underestimated: the bound is multiplied by kSafe. Infinite where the contraction 2 c/m is not
/// below 1.
///
/// c does not see an error that the residual hides: the rotation of a slender robot leaves axial
/// forces much larger than those that would bend it back. The second estimate of the remaining
/// motion is m times the relative residual (see Lag). kHidden is its largest ratio to the true
/// distance in the steps of the robots of python/tests/test_following.py that c underestimates; the
/// bound is not proved.
/// @param correction c, m. @param move m, m. @param residual relative.
/// @param size of the robot, m: smaller moves than its rounding say nothing about the contraction.
inline double distance_bound(double correction, double move, double residual, double size) {
  constexpr double kSafe = 2.0, kHidden = 8.0;
  constexpr double kRounding = 1e-11;  // relative to the size
  if (correction <= kRounding * size && move <= kRounding * size) return kSafe * correction;
  const double contraction = 2.0 * correction / move;
  if (!(contraction < 1.0)) return std::numeric_limits<double>::infinity();
  return std::max(kSafe * correction / (1.0 - contraction), kHidden * residual * move);
}

}  // namespace sinew::run
