/// @file
/// The loads of a body's surroundings in its steps: their forces and stiffness.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/fem/fem_state.hpp"
#include "sinew/fem/open_pressure.hpp"
#include "sinew/mechanics/step_system.hpp"

namespace sinew::fem {

class Assembly;

class BodyLoads {
 public:
  /// @param state must outlive this.
  explicit BodyLoads(const FemState& state);

  /// Takes them at the present positions, and at the velocities that the request asks for.
  void linearise(const mechanics::LinearisationRequest& request);
  /// Adds their stiffness: its symmetric part where the tangent is exact, else never less than it.
  /// @param tangent of the last linearisation. @param assembly of its elements.
  void stiffen(mechanics::Tangent tangent, Assembly& assembly) const;
  /// Drag as it is at the end of the step, not as it was linearised.
  void end_step(const mechanics::StepWeights& weights);

  const Points& forces() const { return forces_; }  ///< (n, 3) N
  const Points& drag() const { return drag_; }      ///< (n, 3) N, beside those
  /// What stiffen() leaves out of the derivative; in statics alone.
  std::span<const FreeBlock> unsymmetric() const { return unsymmetric_; }

 private:
  void find_rates(const mechanics::LinearisationRequest& request);

  const FemState& state_;
  Points forces_, drag_;
  Points rates_, gaps_, accelerations_;  // (n, 3), where loads resist motion
  std::vector<FreeBlock> stiffness_;     // symmetric, row >= column
  std::vector<FreeBlock> unsymmetric_;
};

}  // namespace sinew::fem
