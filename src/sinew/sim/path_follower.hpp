/// @file
/// Path of equilibria under a growing load, parameterised by arc length and therefore able to pass
/// limit points.
#pragma once

#include <functional>
#include <vector>

#include "sinew/sim/path_settings.hpp"

namespace sinew::sim {

class PathLoads;
struct Run;

/// Follows the path from the present equilibrium in steps (PathStep) of adaptive length.
class PathFollower {
 public:
  /// @param run is moved. @param settings step lengths and tolerance.
  PathFollower(Run& run, const PathSettings& settings) : run_(run), settings_(settings) {}
  /// See Simulation::follow_path(). @param visit called at every point, unless empty.
  std::vector<PathPoint> follow(const std::function<void()>& visit);

 private:
  void check() const;
  void settle(PathLoads& loads);
  void rest();

  Run& run_;
  const PathSettings& settings_;
};

}  // namespace sinew::sim
