/// @file
/// Equilibria along a load that grows, through limit points and back, by the length of the path
/// rather than by the load.
#pragma once

#include <functional>
#include <vector>

#include "sinew/sim/path_settings.hpp"

namespace sinew::sim {

class PathLoads;
struct Run;

/// Steps (PathStep) whose length follows how easily they are taken, from the present equilibrium
/// on.
class PathFollower {
 public:
  /// @param run is moved. @param settings see there.
  PathFollower(Run& run, const PathSettings& settings) : run_(run), settings_(settings) {}
  /// See Simulation::follow_path(). @param visit called at every point, if there is something to
  /// call.
  std::vector<PathPoint> follow(const std::function<void()>& visit);

 private:
  void check() const;
  void settle(PathLoads& loads);
  void rest();

  Run& run_;
  const PathSettings& settings_;
};

}  // namespace sinew::sim
