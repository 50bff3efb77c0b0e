/// @file
/// Stability of an equilibrium on the motions that commands, drives and contacts leave free.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/sim/held_motions.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::sim {

class World;

/// The rows that are held at an equilibrium: actuators at a commanded motion or at a limit of their
/// motion, drives by the slope of their curve, normal rows of touching contacts, and tangential
/// rows that stick. Actuators at a limit of their effort and sliding contacts hold nothing. Anchors
/// hold less than nothing.
/// @param problem,effort of the equilibrium.
std::vector<step::HeldRow> held_rows(const step::StepProblem& problem,
                                     std::span<const double> effort);

/// Of these, the rows of contacts.
void append_touching(const step::StepProblem& problem, std::span<const double> effort,
                     std::vector<step::HeldRow>& held);

/// Whether an equilibrium is stable, and where it would go: the lowest eigenvalue of its tangent on
/// the motions that held rows leave.
class Stability {
 public:
  /// @param world linearised with the exact tangent, rows formed, and condensed, at the
  /// equilibrium. @param effort of it.
  Stability(World& world, std::span<const double> effort);

  /// Negative eigenvalues of the restricted tangent; directions that rounding cannot tell from
  /// neutral ones (a body that slides freely) are not counted.
  int negative_pivots() const { return negative_; }
  /// The direction of the lowest curvature, largest entry 1, (all bodies' size(),); empty
  /// where negative_pivots() == 0 or the search found none.
  const VectorX& mode() const { return mode_; }
  /// v^T A v of mode(), N/m; negative.
  double curvature() const { return curvature_; }

 private:
  VectorX find_mode();
  void scale_mode();

  World& world_;
  HeldMotions motions_;
  VectorX mode_;
  double curvature_ = 0.0;
  int negative_ = 0;
};

}  // namespace sinew::sim
