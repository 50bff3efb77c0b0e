/// @file
/// What masses and Rayleigh damping resist the motion of a body with.
#pragma once

#include <cstddef>

#include "sinew/fem/base_carry.hpp"
#include "sinew/fem/system_workspace.hpp"

namespace sinew::fem {

class InertiaForces {
 public:
  /// @param state must outlive this.
  explicit InertiaForces(FemState& state) : state_(state), base_(state) {}

  BaseCarry& base() { return base_; }

  /// Adds -(M a + C v) at the end of the step. @param weights of the step, which a and v follow
  /// from. @param workspace of the linearisation.
  /// @param first whether none of this step was before. @param right (3 free,) N, added to.
  /// @return the norm of what masses take part with, N.
  double add(const mechanics::StepWeights& weights, const SystemWorkspace& workspace, bool first,
             VectorX& right);
  /// J taken out by damping in the step, which is at its end. @param weights of the step.
  /// @param workspace of its last linearisation.
  double damped_work(const mechanics::StepWeights& weights, const SystemWorkspace& workspace);
  double kinetic_energy();  ///< J, now

  std::size_t bytes() const {
    return base_.bytes() +
           sizeof(double) * static_cast<std::size_t>(motion_.size() + force_.size());
  }

 private:
  void multiply_by_mass(const FemModel& elements);
  void multiply_by_stiffness(const SystemWorkspace& workspace);

  FemState& state_;
  BaseCarry base_;
  VectorX motion_, force_;  // (3 free,), from the first step of dynamics on
};

}  // namespace sinew::fem
