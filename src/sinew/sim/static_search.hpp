/// @file
/// Newton search for an equilibrium, or for a step of overdamped motion.
#pragma once

#include "sinew/sim/newton.hpp"
#include "sinew/sim/static_settings.hpp"

namespace sinew::sim {

class Model;
struct Run;

/// Iterations without progress after which a search is given up that has others to fall back on
/// (see NewtonSettings::max_idle): a load that is too large for one step is then divided soon.
int max_idle(const Model& model);

/// Runs Newton's method with the exact tangent and the geometric stiffness of all constraints.
/// Counts iterations in its report.
class StaticSearch {
 public:
  /// Both must outlive it. @param run is moved. @param settings tolerances and limits.
  StaticSearch(Run& run, const StaticSettings& settings) : run_(run), settings_(settings) {}

  Run& run() { return run_; }
  const StaticSettings& settings() const { return settings_; }
  StaticReport& report() { return report_; }
  /// Report of the last search.
  const NewtonReport& last() const { return last_; }

  /// Begins a slow motion from the present state.
  void begin();
  /// Linearises at the present state. @param weights of inertia; none at rest.
  void linearise(const mechanics::StepWeights& weights);
  /// Searches an equilibrium. @param fraction of the homotopy residual that still acts.
  /// @return whether Newton's method converged.
  bool equilibrate(double fraction);
  /// Solves an overdamped step. @param weights of inertia.
  /// @param tolerance of residual and violation. @param max_iterations,max_idle see NewtonSettings.
  /// @return whether it converged.
  bool step(const mechanics::StepWeights& weights, double tolerance, int max_iterations,
            int max_idle = 0);

 private:
  Run& run_;
  const StaticSettings& settings_;
  StaticReport report_;
  NewtonReport last_;
};

}  // namespace sinew::sim
