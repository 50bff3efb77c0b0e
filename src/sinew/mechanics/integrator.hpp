/// @file
/// Time integrators as a few weights. The unknown of every step is the motion dq; an integrator
/// says how much of mass and damping joins the stiffness in A = mass M + damping C + df/dq, so that
/// bodies never know which integrator runs.
#pragma once

#include <string_view>

namespace sinew::mechanics {

enum class Integrator {
  quasi_static,    ///< A dq = p - f(q) + H^T lambda
  backward_euler,  ///< v_f = dq / h; first order, strongly damping
};

/// "quasi-static", "backward-euler".
std::string_view integrator_name(Integrator integrator);

/// With d = q - q_start the motion since the start of the step:
/// velocity v = rate d; inertia M (mass d - momentum v_start); damping C damping d.
struct StepWeights {
  double rate = 0.0;      ///< 1/s: velocity per motion
  double mass = 0.0;      ///< 1/s^2: weight of M in A
  double momentum = 0.0;  ///< 1/s: weight of M v_start on the right side
  double damping = 0.0;   ///< 1/s: weight of the damping matrix C in A
  bool dynamic() const { return mass > 0.0; }
};

/// Backward Euler (Hairer & Wanner 1996, IV.3): M (v - v_start) = h (p - f - C v), q = q_start + h
/// v, divided by h: mass = 1/h^2, momentum = damping = rate = 1/h. Quasi-static: all zero.
/// @param integrator,time_step which one, and h in s, > 0.
StepWeights step_weights(Integrator integrator, double time_step);

}  // namespace sinew::mechanics
