/// @file
/// Simulates the execution of a plan, much more accurately than the plan itself, to verify it.
#pragma once

#include <memory>

#include "sinew/plan/planner.hpp"

namespace sinew::plan {

/// Recorded motion of an arm at increasing times.
struct Replay {
  VectorX times;                   ///< (samples,) s
  MatrixX position, rate, torque;  ///< (samples, coordinates or inputs)
  Points tip, tip_velocity;        ///< (samples, 3) m, m/s
  double tip_error = 0.0;          ///< m, at the end
  double tip_speed = 0.0;          ///< m/s, at the end
  VectorX clearances;              ///< (obstacles,) m, minimum over samples and points
  double clearance() const;        ///< m, minimum over obstacles; +inf without
};

/// Records a replay, state by state.
class Recorder {
 public:
  /// @param arm that moves. @param task completed(), with the goal and the obstacles; must outlive
  /// this. @param times (samples,) s.
  Recorder(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task, const VectorX& times);
  /// Adds the next sample. @param q,rate (coordinates,). @param torque (inputs,) N m.
  void add(const VectorX& q, const VectorX& rate, const VectorX& torque);
  /// Returns the replay, with errors at its last sample. Call it once.
  Replay finish();

 private:
  pcc::ArmDynamics<double> dynamics_;
  const PlanTask& task_;
  Eigen::Index next_ = 0;
  VectorX still_;
  Replay replay_;
};

/// Simulates the torque of a plan on an arm, open loop, by pcc::AdaptiveMotion; between knots it is
/// Plan::torque(). Throws Error(not-converged) if the motion diverges.
/// @param arm the planned one, or another with as many coordinates and inputs.
/// @param task that was planned. @param plan to execute.
/// @param time_step s, approximate time between samples; the duration is a multiple of the actual
/// one.
Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task, const Plan& plan,
              double time_step = 1e-3);
/// As above, with samples at given times. @param arm,task,plan as above. @param times (samples,) s,
/// from 0, increasing.
Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task, const Plan& plan,
              const VectorX& times);

/// Simulates commands through the whole chain of cylinders, lines, actuators and arm, open loop,
/// from the first command to `lead` + the duration of the task. Cylinders start at rest, and the
/// arm in the initial state of the task. Time 0 is that of the first command. Throws
/// Error(wrong-length) if there is not one channel per input.
/// @param arm,task,time_step as above. @param run commands and channels.
Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task, const DriveRun& run,
              double time_step = 1e-3);

/// Defects (intervals,) of the transcription. From each planned knot, the motion under the torque
/// of the plan is integrated to the next knot and compared with that knot. The distance of the
/// states is relative to a change that moves the tip of a straight arm by the tolerances of the
/// goal, so a defect of 1 is as large as missing the goal by its tolerance. Throws
/// Error(not-converged).
/// @param arm,task that were planned. @param plan of the task.
VectorX interval_defects(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task,
                         const Plan& plan);

}  // namespace sinew::plan
