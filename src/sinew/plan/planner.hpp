/// @file
/// Plans optimal motions that bring an arm's tip to a goal, from random cold starts or from a
/// previous plan, and verifies them by simulating the motion of their torques.
#pragma once

#include <cstdint>
#include <ctime>
#include <memory>
#include <string_view>

#include "sinew/plan/collocation.hpp"

namespace sinew::plan {

enum class PlanStatus {
  solved,             ///< the program was solved to its tolerance, and the torques meet the task
  acceptable,         ///< likewise, but only to a hundred times the tolerance
  not_met_on_replay,  ///< the program was solved, but the motion of the torques misses the task
  infeasible,         ///< this and the following are those of the program, see Status
  iteration_limit,
  time_limit,
  failed,
};
/// "solved", "acceptable", "not-met-on-replay", "infeasible", "iteration-limit", "time-limit",
/// "failed".
std::string_view status_name(PlanStatus status);

/// Torques that bring the tip to the goal. The errors are those of the motion under these torques,
/// which pcc::AdaptiveMotion integrates independently of the knots.
struct Plan {
  PlanStatus status = PlanStatus::failed;
  CollocationMethod method = CollocationMethod::radau;
  Knots knots;
  double objective = 0.0;
  double tip_error = 0.0;  ///< m, at the end
  double tip_speed = 0.0;  ///< m/s, at the end
  /// Minimum distance between axis and obstacles, m, at the knots and at four times between them;
  /// without obstacles +inf.
  double clearance = 0.0;
  double planned_tip_error = 0.0;  ///< m, at the last knot of the program
  double planned_tip_speed = 0.0;  ///< m/s
  int iterations = 0;              ///< total over all programs
  int corrections = 0;             ///< programs solved after the first, with another aim or mesh
  double seconds = 0.0;            ///< total for all programs and replays
  ProgramPoint point;              ///< with multipliers, as the start of replan()
  Aim aim;                         ///< of its program

  bool found() const { return status == PlanStatus::solved || status == PlanStatus::acceptable; }
  double duration() const { return knots.times[knots.times.size() - 1]; }
  /// Lengths of the intervals (intervals,), as fractions of the duration.
  VectorX fractions() const;
  /// Torques (inputs,) N m. They are constant or linear over an interval, as the method defines;
  /// with a drive they follow from its commands.
  /// @param time s; clamped to the duration of the plan.
  VectorX torque(double time) const;
};

/// Settings of a planner.
struct PlannerSettings {
  SolverSettings solver;  ///< of each program; the processor time is shared by all of them
  /// Maximum number of further programs, >= 0, while the motion of the torques does not meet the
  /// task. They have a corrected aim or, if this motion differs from that of the program by more
  /// than the tolerances, a finer mesh.
  int corrections = 6;
};

/// Finds plans for one arm and task. Not thread-safe.
class Planner {
 public:
  /// Throws what completed() throws.
  Planner(std::shared_ptr<const pcc::Arm> arm, const PlanTask& task,
          const PlannerSettings& settings = {});

  const PlanTask& task() const { return asked_; }
  /// Plans from the motion under random torques within the limits. With a drive, first plans
  /// torques in this way, inverts the drive, and starts from the result with its multipliers.
  /// @param seed of the random torques.
  Plan plan(std::uint64_t seed);
  /// Plans from a guess at the knots of the task, with commands if the task has a drive. Throws
  /// Error(wrong-length).
  Plan plan(const Knots& guess);
  /// Plans from a plan for another start, goal or limits, on the mesh of that plan. Throws
  /// Error(wrong-length).
  Plan replan(const Plan& before);

  /// The guess from which plan(seed) starts, without a drive.
  Knots guess(std::uint64_t seed) const;

 private:
  /// How well the motion of a plan's torques meets the task.
  struct Verdict;

  Eigen::Index obstacles() const { return static_cast<Eigen::Index>(asked_.obstacles.size()); }
  void set_mesh(const VectorX& fractions);
  ProgramPoint cold_start(std::uint64_t seed);
  ProgramPoint drive_start(std::uint64_t seed);
  /// Solves the program within the remaining processor time. The plan is not yet verified.
  Plan solve_program(const ProgramPoint& start);
  double time_left() const;  ///< s
  /// Solves, replays and corrects until the torques meet the task.
  Plan solve_verified(const ProgramPoint& start);
  Verdict verify(Plan& plan);
  Plan corrected(const Plan& plan, const Verdict& verdict);
  Plan refined_plan(const Plan& plan);

  std::shared_ptr<const pcc::Arm> arm_;
  PlanTask asked_, task_;  // as given, and on the current mesh
  PlannerSettings settings_;
  std::unique_ptr<Collocation> program_;
  pcc::ArmEquations equations_;
  std::clock_t begun_ = 0;
  int before_iterations_ = 0;  // of the programs that led to the start
  double before_seconds_ = 0.0;
};

}  // namespace sinew::plan
