/// @file
/// The search for a stable equilibrium in Simulation::solve_static().
#pragma once

#include <string>
#include <vector>

#include "sinew/law/step_problem.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/statics/overdamped_motion.hpp"
#include "sinew/statics/settling.hpp"
#include "sinew/statics/static_search.hpp"
#include "sinew/world/joint_conflict.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::statics {

class HomotopyPath;

/// Searches an equilibrium in three stages. First, Newton's method with the exact tangent and the
/// geometric stiffness of all constraints. If it fails, along the path r(q, lambda) = (1 - s)
/// r_start, s from 0 to 1, which removes the residual of the start gradually (a convex homotopy;
/// Allgower & Georg 1990, 1.3), in load steps and, where these become short, by arc length
/// (HomotopyPath). If the path ends or turns back, OverdampedMotion under the full load from the
/// last equilibrium on the path.
///
/// Settling then leaves an unstable equilibrium for a stable one.
class StaticSolver {
 public:
  /// @param run is moved. @param settings tolerances and limits.
  StaticSolver(run::Run& run, const StaticSettings& settings);
  /// Throws Error(not-converged), after which the run is as before.
  StaticReport run();

 private:
  void search();
  bool find_without_limits();
  void find();
  bool has_idle_motor() const;
  void read_goal();
  void approach();
  world::JointConflict find_conflict() const;
  double step_load(double smallest);
  bool follow_path(HomotopyPath& path, double& fraction);
  void blend(double fraction);
  std::string describe(double fraction);
  [[noreturn]] void fail_to_find(const std::string& known);

  run::Run& run_;
  const StaticSettings& settings_;
  StaticSearch search_;
  OverdampedMotion motion_;
  Settling settling_;
  StaticReport& report_;  // of search_
  bool limit_point_ = false;
  bool turned_ = false;  // whether the load turns back beyond the last equilibrium on the way
  std::vector<model::ActuatorState> start_;
  std::vector<law::ActuatorBlock> goal_;
};

}  // namespace sinew::statics
