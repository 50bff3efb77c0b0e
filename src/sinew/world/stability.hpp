/// @file
/// Stability of an equilibrium in the motions that commands, drives and contacts permit.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/world/held_motions.hpp"

namespace sinew::world {

class World;

/// The rows that are held at an equilibrium: actuators at a commanded motion or at a limit of their
/// motion, drives with the slope of their curve, normal rows of touching contact points, tangential
/// rows of sticking points, and joints. Actuators at an effort limit and sliding contacts hold
/// nothing. Anchors enter with negative compliance.
/// @param problem,effort of the equilibrium.
std::vector<law::HeldRow> held_rows(const law::StepProblem& problem,
                                    std::span<const double> effort);
/// The same of a world's problem. @param world at the equilibrium. @param effort (rows,) N, of all
/// rows of the world.
std::vector<law::HeldRow> held_rows(const World& world, std::span<const double> effort);

/// (size,) pseudo-random numbers in [-1, 1), always the same: a vector without symmetry, which
/// contains all modes. Starts the search of an eigenvector.
VectorX scattered(Eigen::Index size);

/// Appends the held rows of contacts only.
void append_touching(const law::StepProblem& problem, std::span<const double> effort,
                     std::vector<law::HeldRow>& held);

/// Stability analysis of an equilibrium: the lowest eigenvalue of the tangent, restricted to the
/// motions that the held rows permit, and its direction.
class Stability {
 public:
  /// @param world linearised with the exact tangent, with rows formed, and condensed, at the
  ///   equilibrium. @param effort of the equilibrium.
  Stability(World& world, std::span<const double> effort);

  /// Number of negative eigenvalues of the restricted tangent. Directions that are neutral to
  /// within rounding (a body that slides freely) are not counted.
  int negative_pivots() const { return negative_; }
  /// The direction of the lowest curvature, (all bodies' size(),), scaled to a largest entry of 1;
  /// empty if negative_pivots() == 0 or the search failed.
  const VectorX& mode() const { return mode_; }
  /// v^T A v for v = mode(), N/m; negative.
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

}  // namespace sinew::world
