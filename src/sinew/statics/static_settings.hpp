/// @file
/// Settings and report of Simulation::solve_static().
#pragma once

#include "sinew/run/newton_status.hpp"

namespace sinew::statics {

/// Which equilibria solve_static() accepts.
enum class StabilityChoice {
  stable,  ///< unstable equilibria are left for stable ones, else the search fails
  any,     ///< the one that Newton's method finds: unstable branches can be followed
};

struct StaticSettings {
  double tolerance = 1e-10;  ///< residual relative to the loads; violation relative to the size
  int max_iterations = 60;   ///< Newton iterations in one load step
  int max_load_steps = 256;  ///< the smallest load step is its inverse
  int max_relaxation_steps = 200;  ///< steps of overdamped motion, see StaticSolver
  StabilityChoice stability = StabilityChoice::stable;
};

struct StaticReport {
  run::NewtonStatus status = run::NewtonStatus::converged;
  int iterations = 0;              ///< Newton iterations, over all load steps
  int load_steps = 1;              ///< load steps taken
  int relaxation_steps = 0;        ///< steps of overdamped motion taken
  double residual = 0.0;           ///< N
  double relative_residual = 0.0;  ///< relative to the sum of the forces' norms
  double violation = 0.0;          ///< m, of the law
  /// Number of negative eigenvalues of the exact tangent on the motions that the commands leave
  /// free, that is, of unstable directions of the equilibrium. See Stability.
  int negative_pivots = 0;
  /// Whether small disturbances decay. Without a potential (pressure on an open surface), they may
  /// decay although the symmetric part of the tangent, to which negative_pivots refers, is
  /// indefinite.
  bool stable = true;
};

}  // namespace sinew::statics
