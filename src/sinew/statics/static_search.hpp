/// @file
/// Newton search for an equilibrium, or for a step of overdamped motion.
#pragma once

#include "sinew/core/types.hpp"
#include "sinew/run/newton.hpp"
#include "sinew/statics/static_settings.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::run {
struct Run;
}

namespace sinew::statics {

/// Iterations without progress after which a search is given up that has others to fall back on
/// (see NewtonSettings::max_idle): a load that is too large for one step is then divided soon.
int max_idle(const model::Model& model);

/// Runs Newton's method with the exact tangent and the geometric stiffness of all constraints.
/// Counts iterations in its report.
class StaticSearch {
 public:
  /// Both must outlive it. @param run is moved. @param settings tolerances and limits.
  StaticSearch(run::Run& run, const StaticSettings& settings) : run_(run), settings_(settings) {}

  run::Run& run() { return run_; }
  const StaticSettings& settings() const { return settings_; }
  StaticReport& report() { return report_; }
  /// Report of the last search.
  const run::NewtonReport& last() const { return last_; }

  /// Takes the weights of the state at rest from a time step, whose length materials with memory
  /// need. @param weights without inertia.
  void set_rest(const mechanics::StepWeights& weights) { rest_ = weights; }
  /// Weights of overdamped motion, see OverdampedMotion. @param sigma 1/s^2.
  mechanics::StepWeights overdamped(double sigma) const;

  /// Puts back the report of a search whose state was restored.
  void put_back(const run::NewtonReport& last) { last_ = last; }

  /// Begins a slow motion from the present state, with the contact points that it has.
  void begin();
  /// Linearises at the present state, at rest.
  void linearise() { linearise(rest_); }
  /// Linearises at the present state. @param weights of inertia; none at rest.
  void linearise(const mechanics::StepWeights& weights);
  /// Searches an equilibrium. @param fraction of the homotopy residual that still acts.
  /// @param max_idle see NewtonSettings.
  /// @return whether Newton's method converged.
  bool equilibrate(double fraction, int max_idle = 0);
  /// Solves an overdamped step. @param weights of inertia.
  /// @param tolerance of residual and violation. @param max_iterations,max_idle see NewtonSettings.
  /// @return whether it converged.
  bool step(const mechanics::StepWeights& weights, double tolerance, int max_iterations,
            int max_idle = 0);
  /// Whether the present state is an equilibrium to the settings' tolerance, by its residual and
  /// its violation of the laws. If so, last() says so.
  bool rests();
  /// d^T M d from the change of the residual by inertia in a small motion along d; kg m^2 or
  /// similar. Begins a motion. @param direction (all bodies' size(),).
  double mass_along(const VectorX& direction);
  /// -d.dr/ds of the residual r with the present efforts in a motion s along d, N/m or similar.
  /// It contains the turn of the levers of contact forces, which the tangent of a law of friction
  /// leaves out (rigid::RigidStep). Begins a motion. @param direction (all bodies' size(),).
  double curvature_along(const VectorX& direction);

 private:
  run::Run& run_;
  const StaticSettings& settings_;
  StaticReport report_;
  run::NewtonReport last_;
  mechanics::StepWeights rest_, weights_;  // at rest, and of the last step
};

}  // namespace sinew::statics
