/// @file
/// Newton's search for an equilibrium, of a run at rest or in overdamped motion.
#pragma once

#include "sinew/sim/newton.hpp"
#include "sinew/sim/static_settings.hpp"

namespace sinew::sim {

struct Run;

/// With the exact tangent and the geometric stiffness of all cables. Counts iterations in its
/// report.
class StaticSearch {
 public:
  /// Both outlive it. @param run is moved. @param settings see there.
  StaticSearch(Run& run, const StaticSettings& settings) : run_(run), settings_(settings) {}

  Run& run() { return run_; }
  const StaticSettings& settings() const { return settings_; }
  StaticReport& report() { return report_; }
  /// Of the last search.
  const NewtonReport& last() const { return last_; }

  /// Begins a slow motion from the present state.
  void begin();
  /// There. @param weights of inertia; none at rest.
  void linearise(const mechanics::StepWeights& weights);
  /// Whether Newton ends in an equilibrium. @param fraction of the residual that the world keeps.
  bool equilibrate(double fraction);
  /// Whether it ends an overdamped step. @param weights of inertia. @param tolerance of residual
  /// and motion. @param max_iterations of Newton.
  bool step(const mechanics::StepWeights& weights, double tolerance, int max_iterations);

 private:
  Run& run_;
  const StaticSettings& settings_;
  StaticReport report_;
  NewtonReport last_;
};

}  // namespace sinew::sim
