/// @file
/// What solve_static() takes and says.
#pragma once

#include "sinew/sim/newton_status.hpp"

namespace sinew::sim {

/// Which equilibria solve_static() takes.
enum class StabilityChoice {
  stable,  ///< it leaves unstable ones for stable ones, or fails
  any,     ///< the one that Newton finds: unstable branches can be followed
};

struct StaticSettings {
  double tolerance = 1e-10;  ///< residual relative to the loads; law's violation relative to size
  int max_iterations = 60;   ///< of Newton in one load step
  int max_load_steps = 256;  ///< smallest load step is its inverse
  int max_relaxation_steps = 200;  ///< of overdamped motion, see StaticSolver
  StabilityChoice stability = StabilityChoice::stable;
};

struct StaticReport {
  NewtonStatus status = NewtonStatus::converged;
  int iterations = 0;              ///< Newton's, over all load steps
  int load_steps = 1;              ///< that were taken
  int relaxation_steps = 0;        ///< of overdamped motion that were taken
  double residual = 0.0;           ///< N
  double relative_residual = 0.0;  ///< of the sum of the forces' norms
  double violation = 0.0;          ///< m
  /// Negative eigenvalues of the exact tangent on the motions that commands leave free: directions
  /// in which the equilibrium is unstable. See Stability.
  int negative_pivots = 0;
  /// Whether small disturbances die out. Without a potential (pressure on an open surface) they may
  /// although the symmetric part of the tangent, which negative_pivots counts, is indefinite.
  bool stable = true;
};

}  // namespace sinew::sim
