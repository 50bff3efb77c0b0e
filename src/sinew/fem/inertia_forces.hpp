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
  /// Adds the energy dissipated by damping, and its power, to `end`; call it at the end of the
  /// step.
  /// @param weights of the step. @param workspace of its last linearisation. @param end added to.
  void count_damping(const mechanics::StepWeights& weights, const SystemWorkspace& workspace,
                     mechanics::StepEnd& end);
  /// Adds beta K u, the damping force by velocities relative to the base. @param weights,workspace
  /// as before. @param force (3 free,) N, added to.
  void add_stiffness_damping(const mechanics::StepWeights& weights,
                             const SystemWorkspace& workspace, VectorX& force);
  double kinetic_energy();  ///< J, of the current state

  std::size_t bytes() const {
    return base_.bytes() +
           sizeof(double) * static_cast<std::size_t>(motion_.size() + force_.size());
  }

 private:
  void multiply_by_mass(const FemModel& elements);
  void multiply_by_stiffness(const SystemWorkspace& workspace);
  void damp(const mechanics::StepWeights& weights, const SystemWorkspace& workspace);

  FemState& state_;
  BaseCarry base_;
  VectorX motion_, force_;  // (3 free,), scratch; empty until first used
};

}  // namespace sinew::fem
