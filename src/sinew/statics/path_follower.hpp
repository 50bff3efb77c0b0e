/// @file
/// Path of equilibria under a growing load, parameterised by arc length and therefore able to pass
/// limit points.
#pragma once

#include <functional>

#include "sinew/statics/path_settings.hpp"

namespace sinew::run {
struct Run;
struct State;
}  // namespace sinew::run

namespace sinew::statics {

class PathLoads;
class PathStep;

/// Follows the path from the present equilibrium in steps (PathStep) of adaptive length. Where
/// unstable directions appear or vanish without a limit point (PathChange), it finds the load of
/// the bifurcation to 1 % by bisection and continues along the branch on which it came, in the
/// direction of the tangent.
class PathFollower {
 public:
  /// @param run is moved. @param settings step lengths and tolerance.
  PathFollower(run::Run& run, const PathSettings& settings) : run_(run), settings_(settings) {}
  /// See Simulation::follow_path(). @param visit called at every point, unless empty.
  Path follow(const std::function<void()>& visit);

 private:
  void settle(PathLoads& loads);
  void rest();
  int take(PathStep& step, double& length);
  bool advance(PathStep& step, double& length);
  void add_point(const PathStep& step, Path& path);
  void end_early(Path& path, const PathStep& step, double length, const run::State& start);

  run::Run& run_;
  const PathSettings& settings_;
  bool bisects_ = false;  // whether a step ahead passes a bifurcation
};

}  // namespace sinew::statics
