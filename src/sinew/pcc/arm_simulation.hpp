/// @file
/// An arm by itself in time and at rest, without a world round it: implicit steps and equilibria.
#pragma once

#include <memory>

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/mechanics/integrator.hpp"
#include "sinew/pcc/arm_equations.hpp"

namespace sinew::pcc {

struct ArmStepSettings {
  double time_step = 1e-3;  ///< s, > 0
  mechanics::Integrator integrator =
      mechanics::Integrator::generalized_alpha;  ///< not quasi-static
  double spectral_radius = 0.8;                  ///< of generalized-alpha, 0 to 1
  double tolerance = 1e-9;  ///< of Newton's method: torque left over, of the largest at work
  int max_iterations = 20;
};

/// One run of an arm. Steps are implicit: lumped masses make H nearly singular, so that damping's
/// own rates b / lambda_min(H) are 1e4 to 1e5 1/s, and explicit steps of a millisecond blow up.
class ArmSimulation {
 public:
  /// At rest and straight. Throws Error(out-of-range): a time step or spectral radius that makes
  /// no sense.
  ArmSimulation(std::shared_ptr<const Arm> arm, const ArmStepSettings& settings = {});

  const Arm& arm() const { return equations_.arm(); }
  ArmEquations& equations() { return equations_; }
  double time() const { return time_; }           ///< s
  const VectorX& position() const { return q_; }  ///< (coordinates,) rad; e: m
  const VectorX& rate() const { return rate_; }   ///< (coordinates,) rad/s
  int iterations() const { return iterations_; }  ///< of Newton's method in the last step
  const VectorX& acceleration() const { return new_acceleration_; }  ///< after a step, rad/s^2

  /// What derivatives of the last step need, at its end.
  struct LastStep {
    mechanics::StepWeights weights;
    MatrixX matrix;  ///< of the residual by the motion: dr/dq + dr/dq' dq'/dd + H dq''/dd
    const ArmEquations::Linearisation* linear = nullptr;  ///< until the equations are used again
  };
  const LastStep& last_step() const { return last_; }
  /// A new start. @param q,rate (coordinates,). @param time s.
  void set_state(const VectorX& q, const VectorX& rate, double time = 0.0);

  /// Advances one time step. @param torque (inputs,) N m at its end.
  /// Throws Error(diverged | not-converged); the state is then that before the step.
  void step(const VectorX& torque);

 private:
  ArmEquations equations_;
  ArmStepSettings settings_;
  double time_ = 0.0, step_before_ = 0.0;
  int iterations_ = 0;
  VectorX q_, rate_, first_, second_;
  VectorX motion_, start_, new_rate_, acceleration_, residual_, drive_;
  VectorX new_acceleration_, correction_;
  LastStep last_;
  linalg::LuFactor decomposed_;
};

/// An equilibrium K q + G(q) = B tau.
struct ArmEquilibrium {
  VectorX position;     ///< (coordinates,)
  bool stable = false;  ///< the potential's second derivative is positive definite
  int iterations = 0;
};

/// The equilibrium that a descent of the potential from `start` ends in: Newton's method, made
/// positive definite by a shift, with line search.
/// @param equations of the arm. @param torque (inputs,) N m. @param start (coordinates,).
/// Throws Error(not-converged).
ArmEquilibrium find_equilibrium(ArmEquations& equations, const VectorX& torque,
                                const VectorX& start);

}  // namespace sinew::pcc
