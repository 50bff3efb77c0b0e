/// @file
/// The quadratic program of a closed loop's step: finds the changes of efforts that move the
/// effectors as requested.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::control {

/// Present efforts and motions of the actuators, and their limits after the step.
struct RateLimits {
  VectorX effort, motion;          ///< (actuators,) present values, N or Pa, and m or m^3
  VectorX effort_min, effort_max;  ///< (actuators,) limits that efforts always meet
  VectorX motion_min, motion_max;  ///< (actuators,) limits that motions meet as efforts allow
  VectorX motion_scale;            ///< (actuators,) 1/m or 1/m^3: makes violations comparable
};

/// Solution of the program.
struct RateChoice {
  VectorX change;         ///< (actuators,) u, N or Pa
  bool limited = false;   ///< whether a limit is active
  bool conflict = false;  ///< whether limits of motions were violated for those of efforts
};

/// Solves
///   min |W_ea u - w|_Q^2 + s change |u|_W_aa^2 + s relaxation |lambda + u|_W_aa^2
/// within limits on lambda + u and on delta_a + W_aa u. `change` and `relaxation` are small
/// constants, and s makes them dimensionless: it is the mean over the actuators of how far their
/// efforts, each scaled to the same energy, move the effectors. Without active limits and for
/// vanishing weights, delta_a changes by J^+ w, J = W_ea W_aa^+.
/// @param w_ea (rows, actuators). @param w_aa (actuators, actuators).
/// @param wanted (rows,) w, m or rad. @param weights (rows,) Q. @param limits of the actuators.
RateChoice choose_change(const MatrixX& w_ea, const MatrixX& w_aa, const VectorX& wanted,
                         const VectorX& weights, const RateLimits& limits);

}  // namespace sinew::control
