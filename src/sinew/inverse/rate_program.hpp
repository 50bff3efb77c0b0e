/// @file
/// The quadratic program of a closed loop's step: which changes of efforts move effectors as asked?
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::inverse {

/// Where the actuators are, and where they may be after the step.
struct RateLimits {
  VectorX effort, motion;          ///< (actuators,) now, N or Pa, and m or m^3
  VectorX effort_min, effort_max;  ///< (actuators,) which efforts keep in any case
  VectorX motion_min, motion_max;  ///< (actuators,) which motions keep as far as efforts let them
  VectorX motion_scale;            ///< (actuators,) 1/m or 1/m^3: makes violations comparable
};

/// What the program chose.
struct RateChoice {
  VectorX change;         ///< (actuators,) u, N or Pa
  bool limited = false;   ///< whether a limit is active
  bool conflict = false;  ///< whether limits of motions gave way to those of efforts
};

/// min |W_ea u - w|_Q^2 + s change |u|_W_aa^2 + s relaxation |lambda + u|_W_aa^2 within limits on
/// lambda + u and on delta_a + W_aa u. s makes the weights numbers: the mean over the actuators of
/// what their efforts, each scaled to the same energy, move the effectors. Without active limits
/// and weights delta_a changes by J^+ w, J = W_ea W_aa^+.
/// @param w_ea (rows, actuators). @param w_aa (actuators, actuators). @param wanted (rows,) w, m or
/// rad. @param weights (rows,) Q. @param limits see there.
RateChoice choose_change(const MatrixX& w_ea, const MatrixX& w_aa, const VectorX& wanted,
                         const VectorX& weights, const RateLimits& limits);

}  // namespace sinew::inverse
