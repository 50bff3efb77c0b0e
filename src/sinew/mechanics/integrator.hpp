/// @file
/// Time integrators as a few weights. The unknown of every step is the motion d = q - q_start; an
/// integrator says how velocity and acceleration at the end of the step follow from it, so that
/// bodies never know which integrator runs.
#pragma once

#include <string_view>

namespace sinew::mechanics {

enum class Integrator {
  quasi_static,       ///< A dq = p - f(q) + H^T lambda
  backward_euler,     ///< v_f = d / h; first order, strongly damping
  bdf2,               ///< second order, damps little but what moves fast
  generalized_alpha,  ///< second order, damps fast motion as its spectral radius says
  event_driven,       ///< the midpoint rule from one impact to the next; second order
};

/// "quasi-static", "backward-euler", "bdf2", "generalized-alpha", "event-driven".
std::string_view integrator_name(Integrator integrator);

/// Vectors that a body keeps from step to step besides position and velocity.
int history_count(Integrator integrator);

/// A combination of d, the velocity at the start, and what was kept.
struct Combination {
  double motion = 0.0, velocity = 0.0, first = 0.0, second = 0.0;
};

/// The step's equation is M a + C v + f(q) = p + H^T lambda at its end, with a and v these
/// combinations.
struct StepWeights {
  Combination velocity;       ///< m/s
  Combination acceleration;   ///< m/s^2
  Combination first, second;  ///< what is kept for the next step
  /// The step's error in q is about `error_jump` times the jump of `error_of` over the step.
  double error_jump = 0.0;
  enum class Jump { none, velocity, acceleration, first } error_of = Jump::none;
  double step_before = 0.0;  ///< s; bdf2: for the jump of acceleration
  double time_step = 0.0;    ///< h, s; 0 in statics

  bool dynamic() const { return acceleration.motion > 0.0; }
};

/// Backward Euler (Hairer & Wanner 1996, IV.3): v = d/h, a = (v - v_start)/h.
/// BDF2 of variable step (Hairer, Norsett & Wanner 1993, III.5), with w = h/h_before:
///   v = ((1 + 2w)/(1 + w) d - w^2/(1 + w) d_before)/h, and likewise a from v;
/// keeps d and the velocity at the start.
/// Generalized-alpha (Chung & Hulbert, J. Appl. Mech. 60, 1993) in the form of Arnold & Bruels
/// (Multibody Syst. Dyn. 18, 2007), which has the equation of motion hold at the end of the step:
///   d = h v_start + h^2 ((1/2 - beta) a_start + beta a'),
///   v = v_start + h ((1 - gamma) a_start + gamma a'),
///   (1 - alpha_m) a' + alpha_m a_start = (1 - alpha_f) a + alpha_f a_before,
///   alpha_m = (2 rho - 1)/(rho + 1), alpha_f = rho/(rho + 1), gamma = 1/2 - alpha_m + alpha_f,
///   beta = (1 - alpha_m + alpha_f)^2 / 4;
/// keeps the algorithmic acceleration a' and the true one a. rho = 1 conserves the energy of linear
/// motion, rho = 0 annihilates fast motion in one step. The first step of either is one of backward
/// Euler, which keeps the second order.
/// Of event-driven integration these are the weights of a part that is solved, backward Euler's;
/// see midpoint_weights().
/// @param integrator which one.
/// @param time_step h, s, > 0.
/// @param step_before the last step, s; 0: none, nothing was kept.
/// @param spectral_radius rho of generalized-alpha, 0 to 1.
StepWeights step_weights(Integrator integrator, double time_step, double step_before = 0.0,
                         double spectral_radius = 0.8);

/// The implicit midpoint rule (Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006,
/// VI.4): a step of backward Euler over h/2, whose motion is then repeated,
///   d = 2 d_half,   v = 2 d/h - v_start,   a = (v - v_start)/h.
/// It needs no history, is symmetric, of second order, and exact for constant accelerations.
/// @param time_step h, s, > 0. @return of the whole step, whose motion is d.
StepWeights midpoint_weights(double time_step);

}  // namespace sinew::mechanics
