/// @file
/// Plans: the optimal motion that brings an arm's tip to a goal, found from cold random starts or
/// from a plan made before, and verified by the motion of its torques.
#pragma once

#include <cstdint>
#include <ctime>
#include <memory>
#include <string_view>

#include "sinew/plan/collocation.hpp"

namespace sinew::plan {

enum class PlanStatus {
  solved,             ///< the program to its tolerance, and its torques do what is asked for
  acceptable,         ///< the same, the program to a hundred times its tolerance
  not_met_on_replay,  ///< the program was solved, and the motion of its torques misses
  infeasible,         ///< of the program from here on, see Status
  iteration_limit,
  time_limit,
  failed,
};
/// "solved", "acceptable", "not-met-on-replay", "infeasible", "iteration-limit", "time-limit",
/// "failed".
std::string_view status_name(PlanStatus status);

/// Torques that bring the tip to the goal. Errors are those of the motion that the torques cause,
/// integrated anew by pcc::AdaptiveMotion without regard to the knots.
struct Plan {
  PlanStatus status = PlanStatus::failed;
  CollocationMethod method = CollocationMethod::radau;
  Knots knots;
  double objective = 0.0;
  double tip_error = 0.0;  ///< m, at the end
  double tip_speed = 0.0;  ///< m/s, at the end
  /// m, the least between axis and obstacles, at the knots and in four places between; none: +inf
  double clearance = 0.0;
  double planned_tip_error = 0.0;  ///< m, of the program's own last knot
  double planned_tip_speed = 0.0;  ///< m/s
  int iterations = 0;              ///< of all programs
  int corrections = 0;   ///< programs solved after the first, with another aim or more knots
  double seconds = 0.0;  ///< of all programs and replays
  ProgramPoint point;    ///< with multipliers: the start of the next
  Aim aim;               ///< of its program, on its knots

  bool found() const { return status == PlanStatus::solved || status == PlanStatus::acceptable; }
  double duration() const { return knots.times[knots.times.size() - 1]; }
  /// (intervals,) of the duration.
  VectorX fractions() const;
  /// (inputs,) N m, as the method means it: constant over an interval or linear; with a drive what
  /// its commands cause.
  /// @param time s; before the plan its first, after it its last.
  VectorX torque(double time) const;
};

struct PlannerSettings {
  SolverSettings solver;  ///< of each program; processor time is that of all together
  /// >= 0, most programs after the first while the motion of the torques does not do what is asked
  /// for: with the aim moved by what it misses or, where the motion differs from the program's by
  /// more than the tolerances, on a finer mesh.
  int corrections = 6;
};

/// Finds plans for one arm and task. Not to be used from two threads at once.
class Planner {
 public:
  /// Throws what completed() throws.
  Planner(std::shared_ptr<const pcc::Arm> arm, const PlanTask& task,
          const PlannerSettings& settings = {});

  const PlanTask& task() const { return asked_; }
  /// From the motion that random torques within the limits cause; with a drive from the plan of
  /// torques found so, inverted, with its multipliers. @param seed of the random torques.
  Plan plan(std::uint64_t seed);
  /// From a guess at the task's knots, with its drive where the task has one: Error(wrong-length).
  Plan plan(const Knots& guess);
  /// From a plan for another start, goal or limits, on its knots' fractions of the duration.
  /// Throws Error(wrong-length).
  Plan replan(const Plan& before);

  /// That of plan(seed), without a drive.
  Knots guess(std::uint64_t seed) const;

 private:
  /// What the motion of a plan's torques comes to.
  struct Verdict;

  Eigen::Index obstacles() const { return static_cast<Eigen::Index>(asked_.obstacles.size()); }
  void set_mesh(const VectorX& fractions);
  ProgramPoint cold_start(std::uint64_t seed);
  ProgramPoint drive_start(std::uint64_t seed);
  /// The program's plan, not yet replayed, within the processor time that is left.
  Plan solve_program(const ProgramPoint& start);
  double time_left() const;  ///< s
  /// Solves, replays, and corrects until the torques do what is asked for.
  Plan solve_verified(const ProgramPoint& start);
  Verdict verify(Plan& plan);
  Plan corrected(const Plan& plan, const Verdict& verdict);
  Plan refined_plan(const Plan& plan);

  std::shared_ptr<const pcc::Arm> arm_;
  PlanTask asked_, task_;  // as given, and on the mesh at hand
  PlannerSettings settings_;
  std::unique_ptr<Collocation> program_;
  pcc::ArmEquations equations_;
  std::clock_t begun_ = 0;
  int before_iterations_ = 0;  // of what led to the start
  double before_seconds_ = 0.0;
};

}  // namespace sinew::plan
