/// @file
/// Stability of an equilibrium on the motions that commands, drives and contacts leave free.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
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

/// The exact tangent A of an equilibrium restricted to the motions that held rows H leave, which is
/// A + H^T C^-1 H, and for C = 0 A on the null space of H; its negative eigenvalues are counted by
/// step::negative_directions(), with S = W + C. Its inverse on those motions is T = A^-1 - Y S^-1
/// Y^T, Y = A^-1 H^T.
///
/// Loads without a potential (pressure on an open surface) are counted by the symmetric part of
/// their tangent.
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
  int count();
  void move_rows(std::size_t rows);
  VectorX find_mode();
  void scale_mode();
  void apply_inverse(const VectorX& right, VectorX& result);

  World& world_;
  std::vector<step::HeldRow> held_;
  MatrixX moved_;    // Y, (size, held)
  MatrixX inverse_;  // pseudo-inverse of S, (held, held)
  VectorX mode_;
  double curvature_ = 0.0;
  int negative_ = 0;
};

}  // namespace sinew::sim
