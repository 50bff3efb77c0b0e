/// @file
/// Continuation of load stepping by arc length.
#pragma once

#include <span>

#include "sinew/law/step_problem.hpp"
#include "sinew/model/actuator.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::statics {

class PathStep;

/// The equilibria of a homotopy (load_steps.hpp), with its commands interpolated from the values at
/// the start to the goal, followed by arc length (PathStep): beyond the last one that Newton's
/// method reaches in load steps. The path then continues, and the next equilibrium is farther away
/// than Newton's method finds it; or the load turns back, and the last equilibrium before names the
/// limit point.
class HomotopyPath {
 public:
  enum class End {
    full_load,  ///< the last point is at the end of the homotopy or at most 10 % beyond
    turned,     ///< the load turns back; the last point is just before
    lost,       ///< too many iterations, or no equilibrium ahead
  };

  /// All must outlive it. @param run is moved; its homotopy keeps the residual of the start.
  /// @param start,goal (actuators,) of the homotopy. @param tolerance see PathStep.
  HomotopyPath(run::Run& run, std::span<const model::ActuatorState> start,
               std::span<const law::ActuatorBlock> goal, double tolerance)
      : run_(run), start_(start), goal_(goal), tolerance_(tolerance) {}

  /// Whether the path can be followed: all commands are efforts without drives, and PathStep
  /// supports all parts.
  bool is_possible() const;
  /// Follows it from the present equilibrium; leaves the run at the last point.
  /// @param fraction of the residual that acts at the start, overwritten by that at the last point.
  End follow(double& fraction);

 private:
  void set_fraction(double fraction);
  bool advance(PathStep& step);

  run::Run& run_;
  std::span<const model::ActuatorState> start_;
  std::span<const law::ActuatorBlock> goal_;
  double tolerance_;
};

}  // namespace sinew::statics
