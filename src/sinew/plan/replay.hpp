/// @file
/// A plan carried out by an arm, with fine implicit steps: what the plan is worth.
#pragma once

#include <memory>

#include "sinew/plan/planner.hpp"

namespace sinew::plan {

/// The arm's motion over equal steps.
struct Replay {
  VectorX times;                   ///< (steps + 1,) s
  MatrixX position, rate, torque;  ///< (steps + 1, coordinates or inputs)
  Points tip, tip_velocity;        ///< (steps + 1, 3) m, m/s
  double tip_error = 0.0;          ///< m, at the end
  double tip_speed = 0.0;          ///< m/s, at the end
  double clearance = 0.0;          ///< m, the least of all times, points and obstacles; none: +inf
};

/// Fills a replay, state by state.
class Recorder {
 public:
  /// @param arm that moves. @param task completed(), of the goal and the obstacles.
  /// @param steps how many. @param time_step s.
  Recorder(const std::shared_ptr<const pcc::Arm>& arm, const Task& task, Eigen::Index steps,
           double time_step);
  /// @param q,rate (coordinates,). @param torque (inputs,) that led there.
  void add(const VectorX& q, const VectorX& rate, const VectorX& torque);
  Replay finish();

 private:
  pcc::ArmDynamics<double> dynamics_;
  const Task& task_;
  Eigen::Index next_ = 0;
  VectorX still_;
  Replay replay_;
};

/// The plan's torque on an arm, open loop, by generalized-alpha steps. @param arm that carries it
/// out, the planned one or another of as many coordinates and inputs. @param task that was planned.
/// @param plan what to do. @param time_step s, about: a whole number of steps makes the duration.
Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const Task& task, const Plan& plan,
              double time_step = 1e-3);

/// Commands through the whole chain, open loop: cylinders at rest, lines, actuators and an arm that
/// stands as the task starts, from the first command to `lead` + the task's duration. The replay's
/// times begin with the commands. @param arm,task,time_step as above. @param run the commands, and
/// what they drive.
/// Throws Error(wrong-length): not a channel for each input.
Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const Task& task, const DriveRun& run,
              double time_step = 1e-3);

}  // namespace sinew::plan
