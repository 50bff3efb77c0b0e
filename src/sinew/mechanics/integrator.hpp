/// @file
/// Time integrators as sets of weights. The unknown of every step is the motion d = q - q_start. An
/// integrator gives velocity and acceleration at the end of the step as combinations of d and of
/// known vectors, so bodies need not know which integrator runs.
#pragma once

#include <string_view>

namespace sinew::mechanics {

/// The available integrators.
enum class Integrator {
  quasi_static,       ///< A dq = p - f(q) + H^T lambda
  backward_euler,     ///< v = d / h; first order, strong numerical damping
  bdf2,               ///< second order, damps mainly fast motion
  generalized_alpha,  ///< second order, damps fast motion according to its spectral radius
  event_driven,       ///< the midpoint rule from one impact to the next; second order
};

/// Name: "quasi-static", "backward-euler", "bdf2", "generalized-alpha" or "event-driven".
std::string_view integrator_name(Integrator integrator);

/// Number of vectors that a body keeps from step to step besides position and velocity.
int history_count(Integrator integrator);

/// Weights of a linear combination of d, the velocity at the start of the step, and the two vectors
/// of the history.
struct Combination {
  double motion = 0.0, velocity = 0.0, first = 0.0, second = 0.0;
};

/// Weights of a step, whose equation is M a + C v + f(q) = p + H^T lambda at its end.
struct StepWeights {
  Combination velocity;       ///< v at the end of the step, m/s
  Combination acceleration;   ///< a at the end of the step, m/s^2
  Combination first, second;  ///< history for the next step
  /// The error of the step in q is about `error_jump` times the change of `error_of` over the step.
  double error_jump = 0.0;
  enum class Jump { none, velocity, acceleration, first } error_of = Jump::none;
  double step_before = 0.0;  ///< previous step, s; for the change of acceleration in bdf2
  double time_step = 0.0;    ///< h, s; 0 in statics

  bool dynamic() const { return acceleration.motion > 0.0; }
};

/// Backward Euler (Hairer & Wanner 1996, IV.3): v = d/h, a = (v - v_start)/h.
/// BDF2 with variable steps (Hairer, Norsett & Wanner 1993, III.5), with w = h/h_before:
///   v = ((1 + 2w)/(1 + w) d - w^2/(1 + w) d_before)/h, and likewise a from v;
/// it keeps d and the velocity at the start.
/// Generalized-alpha (Chung & Hulbert, J. Appl. Mech. 60, 1993) in the form of Arnold & Bruels
/// (Multibody Syst. Dyn. 18, 2007), in which the equation of motion holds at the end of the step:
///   d = h v_start + h^2 ((1/2 - beta) a_start + beta a'),
///   v = v_start + h ((1 - gamma) a_start + gamma a'),
///   (1 - alpha_m) a' + alpha_m a_start = (1 - alpha_f) a + alpha_f a_before,
///   alpha_m = (2 rho - 1)/(rho + 1), alpha_f = rho/(rho + 1), gamma = 1/2 - alpha_m + alpha_f,
///   beta = (1 - alpha_m + alpha_f)^2 / 4;
/// it keeps the algorithmic acceleration a' and the true one a. rho = 1 conserves the energy of
/// linear motion, but keeps every error of the efforts of held rows (model/held_rows.hpp); rho = 0
/// annihilates fast motion in one step. The first step of BDF2 and
/// generalized-alpha is a backward Euler step, which preserves the second order.
/// For event-driven integration, these are the backward Euler weights of the half step that is
/// solved; see midpoint_weights().
/// @param integrator which one.
/// @param time_step h, s, > 0.
/// @param step_before the previous step, s; 0 if there is none, and no history.
/// @param spectral_radius rho of generalized-alpha, 0 to 1.
StepWeights step_weights(Integrator integrator, double time_step, double step_before = 0.0,
                         double spectral_radius = 0.8);

/// Weights of the implicit midpoint rule (Hairer, Lubich & Wanner, Geometric Numerical Integration,
/// 2006, VI.4): a backward Euler step over h/2 whose motion is then repeated,
///   d = 2 d_half,   v = 2 d/h - v_start,   a = (v - v_start)/h.
/// It needs no history, is symmetric and of second order, and is exact for constant accelerations.
/// @param time_step h, s, > 0. @return the weights of the whole step, with motion d.
StepWeights midpoint_weights(double time_step);

}  // namespace sinew::mechanics
