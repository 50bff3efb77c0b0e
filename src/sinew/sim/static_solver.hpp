/// @file
/// How Simulation::solve_static() comes to a stable equilibrium.
#pragma once

#include <string>
#include <vector>

#include "sinew/sim/actuator.hpp"
#include "sinew/sim/joint_conflict.hpp"
#include "sinew/sim/overdamped_motion.hpp"
#include "sinew/sim/static_search.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::sim {

struct Run;

/// Finds an equilibrium, first by Newton with the exact tangent and the cables' geometric stiffness
/// in one go; where that fails, along the path on which the imbalance of the start is taken away
/// bit by bit: r(q, lambda) = (1 - s) r_start, s from 0 to 1 (a convex homotopy; Allgower & Georg
/// 1990, 1.3); and where that ends, by OverdampedMotion under the full load from the last
/// equilibrium of the path.
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
  void search();
  bool find_without_limits();
  void find();
  void read_goal();
  void approach();
  JointConflict find_conflict() const;
  double step_load();
  void blend(double fraction);
  std::string describe(double fraction);
  std::string describe_limit_point();
  [[noreturn]] void fail_to_find(const std::string& known);
  void follow_surfaces();
  void settle();

  Run& run_;
  const StaticSettings& settings_;
  StaticSearch search_;
  OverdampedMotion motion_;
  StaticReport& report_;  // of search_
  bool limit_point_ = false;
  std::vector<ActuatorState> start_;
  std::vector<step::ActuatorBlock> goal_;
};

}  // namespace sinew::sim
