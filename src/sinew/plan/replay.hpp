/// @file
/// A plan carried out by an arm, to an accuracy far finer than the plan's: what the plan is worth.
#pragma once

#include <memory>

#include "sinew/plan/planner.hpp"

namespace sinew::plan {

/// The arm's motion at increasing times.
struct Replay {
  VectorX times;                   ///< (samples,) s
  MatrixX position, rate, torque;  ///< (samples, coordinates or inputs)
  Points tip, tip_velocity;        ///< (samples, 3) m, m/s
  double tip_error = 0.0;          ///< m, at the end
  double tip_speed = 0.0;          ///< m/s, at the end
  VectorX clearances;              ///< (obstacles,) m, the least of all samples and points
  double clearance() const;        ///< m, the least of them; no obstacles: +inf
};

/// Fills a replay, state by state.
class Recorder {
 public:
  /// @param arm that moves. @param task completed(), of the goal and the obstacles.
  /// @param times (samples,) s.
  Recorder(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task, const VectorX& times);
  /// @param q,rate (coordinates,). @param torque (inputs,) that led there.
  void add(const VectorX& q, const VectorX& rate, const VectorX& torque);
  Replay finish();

 private:
  pcc::ArmDynamics<double> dynamics_;
  const PlanTask& task_;
  Eigen::Index next_ = 0;
  VectorX still_;
  Replay replay_;
};

/// The plan's torque on an arm, open loop, as the plan means it between its knots, by
/// pcc::AdaptiveMotion. @param arm that carries it out, the planned one or another of as many
/// coordinates and inputs. @param task that was planned. @param plan what to do.
/// @param time_step s, about, between samples: a whole number of them makes the duration.
/// Throws Error(not-converged): a motion without end of speed.
Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task, const Plan& plan,
              double time_step = 1e-3);
/// The same at given times (samples,) s, from 0, increasing.
Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task, const Plan& plan,
              const VectorX& times);

/// Commands through the whole chain, open loop: cylinders at rest, lines, actuators and an arm that
/// stands as the task starts, from the first command to `lead` + the task's duration. The replay's
/// times begin with the commands. @param arm,task,time_step as above. @param run the commands, and
/// what they drive.
/// Throws Error(wrong-length): not a channel for each input.
Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task, const DriveRun& run,
              double time_step = 1e-3);

/// What the transcription leaves out: from each planned knot the arm's motion under the plan's
/// torque to the next knot, against that knot. (intervals,), the distance of the states over what
/// moves the tip by the goal's tolerances on a straight arm: 1 is as bad as the goal missed by the
/// tolerance. @param arm,task that was planned. @param plan of it. Throws Error(not-converged).
VectorX interval_defects(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task,
                         const Plan& plan);

}  // namespace sinew::plan
