/// @file
/// Simulates a single arm outside sim::Simulation: implicit time steps, and equilibria.
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
  double tolerance = 1e-9;  ///< of Newton's method: residual relative to the largest torque
  int max_iterations = 20;
};

/// A simulation of one arm. Its steps are implicit, since lumped masses make H nearly singular: the
/// rates of damping, b / lambda_min(H), are 2e3 to 6e6 1/s, and explicit steps of 1 ms diverge.
class ArmSimulation {
 public:
  /// Starts at rest, with the arm straight. Throws Error: out-of-range (time step, spectral
  /// radius), unknown-choice (a quasi-static integrator).
  ArmSimulation(std::shared_ptr<const Arm> arm, const ArmStepSettings& settings = {});

  const Arm& arm() const { return equations_.arm(); }
  ArmEquations& equations() { return equations_; }
  double time() const { return time_; }           ///< s
  const VectorX& position() const { return q_; }  ///< (coordinates,) rad; e: m
  const VectorX& rate() const { return rate_; }   ///< (coordinates,) rad/s
  int iterations() const { return iterations_; }  ///< of Newton's method in the last step
  const VectorX& acceleration() const { return new_acceleration_; }  ///< after a step, rad/s^2

  /// Results at the end of the last step, for its derivatives.
  struct LastStep {
    mechanics::StepWeights weights;
    MatrixX matrix;  ///< Jacobian for the motion d: dr/dq + dr/dq' dq'/dd + H dq''/dd
    const ArmEquations::Linearisation* linear = nullptr;  ///< valid until the next linearise()
  };
  const LastStep& last_step() const { return last_; }
  /// Sets the state. @param q,rate (coordinates,). @param time s.
  void set_state(const VectorX& q, const VectorX& rate, double time = 0.0);

  /// Advances one time step. Throws Error(diverged | not-converged), and then keeps the state
  /// before the step. @param torque (inputs,) N m at the end of the step.
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
  bool stable = false;  ///< whether the Hessian of the potential is positive definite
  int iterations = 0;
};

/// Finds an equilibrium by descent of the potential from `start`: Newton's method with line search,
/// whose Hessian is shifted to be positive definite. Throws Error(not-converged).
/// @param equations of the arm. @param torque (inputs,) N m. @param start (coordinates,).
ArmEquilibrium find_equilibrium(ArmEquations& equations, const VectorX& torque,
                                const VectorX& start);

}  // namespace sinew::pcc
