/// @file
/// How Simulation::solve_static() comes to a stable equilibrium.
#pragma once

#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/sim/actuator.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/state.hpp"
#include "sinew/sim/static_settings.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::sim {

struct Run;
class Stability;

/// Finds an equilibrium, first by Newton with the exact tangent and the cables' geometric stiffness
/// in one go; where that fails, along the path on which the imbalance of the start is taken away
/// bit by bit: r(q, lambda) = (1 - s) r_start, s from 0 to 1 (a convex homotopy; Allgower & Georg
/// 1990, 1.3); and where that ends, by the overdamped motion M dq/dt = r(q) under the full load
/// from the last equilibrium of the path: pseudo-transient continuation (Kelley & Keyes, SIAM J.
/// Numer. Anal. 35 (1998) 508).
///
/// An equilibrium with negative pivots (Stability) is left along the direction of its lowest
/// curvature; the overdamped motion, a descent of the potential where there is one, then ends in
/// another. Where it comes back, the equilibrium is stable after all: that is possible without a
/// potential alone.
class StaticSolver {
 public:
  /// @param run is moved. @param settings see there.
  StaticSolver(Run& run, const StaticSettings& settings);
  /// Throws Error(not-converged), the run then being as it was.
  StaticReport run();

 private:
  enum class Departure { arrived, returned, failed };

  void read_goal();
  static mechanics::LinearisationRequest request(const mechanics::StepWeights& weights);
  NewtonReport solve(const mechanics::StepWeights& weights, double tolerance, int max_iterations);
  bool equilibrate(double share, int max_iterations);
  void linearise(const mechanics::StepWeights& weights);

  void approach();
  double step_load();
  void blend(double share);
  std::string describe(double share);
  std::string describe_limit_point();
  [[noreturn]] void fail_to_find(const std::string& known);
  void follow_surfaces();
  void settle();

  // static_relaxation.cpp
  bool relax_from_here();
  Departure leave(const Stability& stability, double disturbance);
  Departure relax(double sigma, double near);
  double mass_along(const VectorX& direction);
  std::vector<Points> positions() const;
  double moved_since(const std::vector<Points>& before) const;

  Run& run_;
  const StaticSettings& settings_;
  StaticReport report_;
  NewtonReport last_;  // of the last search
  bool limit_point_ = false;
  std::vector<ActuatorState> start_;
  std::vector<step::ActuatorBlock> goal_;
  State sound_;               // of the last equilibrium, or before the last step
  std::vector<Points> left_;  // of each body: positions of the unstable equilibrium that was left
};

}  // namespace sinew::sim
