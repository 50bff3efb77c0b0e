/// @file
/// Inertia and Rayleigh damping forces of a body.
#pragma once

#include <cstddef>

#include "sinew/fem/base_carry.hpp"
#include "sinew/fem/system_workspace.hpp"

namespace sinew::fem {

/// Computes inertia and Rayleigh damping forces, their work and the kinetic energy.
class InertiaForces {
 public:
  /// @param state must outlive this.
  explicit InertiaForces(FemState& state) : state_(state), base_(state) {}

  BaseCarry& base() { return base_; }

  /// Adds -(M a + C v) at the end of the step. @param weights of the step, which define a and v.
  /// @param workspace of the linearisation.
  /// @param first whether this is the first linearisation of the step. @param right (3 free,) N,
  ///   added to.
  /// @return the norm of the part from masses, M (a + alpha v), N.
  double add(const mechanics::StepWeights& weights, const SystemWorkspace& workspace, bool first,
             VectorX& right);
  /// Energy dissipated by damping, J; call it at the end of the step. @param weights of the step.
  /// @param workspace of its last linearisation.
  double damped_work(const mechanics::StepWeights& weights, const SystemWorkspace& workspace);
  double kinetic_energy();  ///< J, of the current state

  std::size_t bytes() const {
    return base_.bytes() +
           sizeof(double) * static_cast<std::size_t>(motion_.size() + force_.size());
  }

 private:
  void multiply_by_mass(const FemModel& elements);
  void multiply_by_stiffness(const SystemWorkspace& workspace);

  FemState& state_;
  BaseCarry base_;
  VectorX motion_, force_;  // (3 free,), scratch; empty until first used
};

}  // namespace sinew::fem
