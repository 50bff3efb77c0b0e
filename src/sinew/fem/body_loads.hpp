/// @file
/// Forces and stiffness of the loads on a body during its steps.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/fem/fem_state.hpp"
#include "sinew/fem/open_pressure.hpp"
#include "sinew/mechanics/step_system.hpp"

namespace sinew::fem {

class Assembly;

/// Evaluates the loads of one body (LoadSet) and keeps their forces and stiffness blocks.
class BodyLoads {
 public:
  /// @param state must outlive this.
  explicit BodyLoads(const FemState& state);

  /// Evaluates the loads at the current positions, and drag at the velocities for the request: that
  /// at the start of the step for a single linearisation, that of the iterate for Newton's method.
  void linearise(const mechanics::LinearisationRequest& request);
  /// Adds the load stiffness to the matrix: its symmetric part if the tangent is exact, otherwise a
  /// positive semidefinite majorant of it.
  /// @param tangent of the last linearisation. @param assembly of its elements.
  void stiffen(mechanics::Tangent tangent, Assembly& assembly) const;
  /// Evaluates drag at the end of the step, in place of its linearisation.
  void end_step(const mechanics::StepWeights& weights);

  const Points& forces() const { return forces_; }  ///< (n, 3) N
  const Points& drag() const { return drag_; }      ///< (n, 3) N, not included in forces()
  /// The unsymmetric part of the derivative, which stiffen() omits. Only in statics.
  std::span<const FreeBlock> unsymmetric() const { return unsymmetric_; }

 private:
  void find_rates(const mechanics::LinearisationRequest& request);

  const FemState& state_;
  Points forces_, drag_;
  Points rates_, gaps_, accelerations_;  // (n, 3), if loads resist motion; see LoadState
  std::vector<FreeBlock> stiffness_;     // symmetric, one block per pair of nodes
  std::vector<FreeBlock> unsymmetric_;
};

}  // namespace sinew::fem
