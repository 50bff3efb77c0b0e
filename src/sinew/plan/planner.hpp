/// @file
/// Plans: the optimal motion that brings an arm's tip to a goal, found from cold random starts or
/// from a plan made before.
#pragma once

#include <cstdint>
#include <memory>

#include "sinew/plan/collocation.hpp"

namespace sinew::plan {

struct Plan {
  Status status = Status::failed;
  Method method = Method::hermite_simpson;
  Knots knots;
  double objective = 0.0;
  double tip_error = 0.0;  ///< m, of the plan itself at its end
  double tip_speed = 0.0;  ///< m/s
  int iterations = 0;
  double seconds = 0.0;  ///< of the solver; with a drive, like the iterations, of both programs
  ProgramPoint point;    ///< with multipliers: the start of the next

  bool found() const { return status == Status::solved || status == Status::acceptable; }
  double duration() const { return knots.times[knots.times.size() - 1]; }
  /// (inputs,) N m, as the method means it: constant over an interval or linear; with a drive what
  /// its commands cause.
  /// @param time s; before the plan its first, after it its last.
  VectorX torque(double time) const;
};

/// Finds plans for one arm and task. Not to be used from two threads at once.
class Planner {
 public:
  /// Throws what completed() throws.
  Planner(std::shared_ptr<const pcc::Arm> arm, const Task& task,
          const SolverSettings& settings = {});

  const Task& task() const { return task_; }
  /// From the motion that random torques within the limits cause; with a drive from the plan of
  /// torques found so, inverted, with its multipliers. @param seed of the random torques.
  Plan plan(std::uint64_t seed);
  /// From a guess at the task's knots, with its drive where the task has one: Error(wrong-length).
  Plan plan(const Knots& guess);
  /// From a plan for another start, goal or limits, on a grid of as many knots.
  /// Throws Error(wrong-length).
  Plan replan(const Plan& before);

  /// That of plan(seed), without a drive.
  Knots guess(std::uint64_t seed) const;

 private:
  Plan plan_drive(std::uint64_t seed);
  Plan finish(ProgramResult result);

  std::shared_ptr<const pcc::Arm> arm_;
  Task task_;
  SolverSettings settings_;
  Collocation program_;
  pcc::ArmEquations equations_;
};

}  // namespace sinew::plan
