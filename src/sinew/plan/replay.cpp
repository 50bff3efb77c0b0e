#include "sinew/plan/replay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "sinew/core/whole.hpp"
#include "sinew/pcc/adaptive_motion.hpp"

namespace sinew::plan {

namespace {

/// Lowers clearances to the distances of the arm's axis from the obstacles, where these are less.
void lower(VectorX& clearances, const pcc::ArmDynamics<double>& dynamics,
           const std::vector<Obstacle>& obstacles) {
  constexpr int kPoints = 20;  // per segment
  for (int s = 0; s < dynamics.arm().segments(); ++s) {
    for (int i = 0; i <= kPoints; ++i) {
      const pcc::Vec3<double> at = dynamics.position({s, static_cast<double>(i) / kPoints});
      for (std::size_t o = 0; o < obstacles.size(); ++o) {
        double& least = clearances[static_cast<Eigen::Index>(o)];
        least = std::min(least, obstacles[o].distance({at.x, at.y, at.z}));
      }
    }
  }
}

/// Simulates a torque. @param kinks times (s), increasing, at which the torque is not smooth.
Replay replay_torque(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task_given,
                     const pcc::AdaptiveMotion::Torque& torque_at, const VectorX& kinks,
                     const VectorX& times) {
  const PlanTask task = completed(*arm, task_given);
  pcc::AdaptiveMotion motion(arm);
  motion.set_state(task.start.position, task.start.rate);
  Recorder recorder(arm, task, times);
  recorder.add(motion.position(), motion.rate(), torque_at(0.0));
  Eigen::Index kink = 0;
  for (Eigen::Index k = 1; k < times.size(); ++k) {
    for (; kink < kinks.size() && kinks[kink] < times[k]; ++kink) {
      if (kinks[kink] > motion.time()) motion.advance(kinks[kink], torque_at);
    }
    motion.advance(times[k], torque_at);
    recorder.add(motion.position(), motion.rate(), torque_at(times[k]));
  }
  return recorder.finish();
}

/// Times at equal steps of about `time_step` over a duration.
VectorX equal_times(double duration, double time_step) {
  const double steps = std::max(1.0, std::round(duration / time_step));
  const auto count =
      whole_count<Eigen::Index>(steps, 1e9, "time steps of a plan", "increase the time step");
  return VectorX::LinSpaced(count + 1, 0.0, duration);
}

}  // namespace

double Replay::clearance() const {
  return clearances.size() > 0 ? clearances.minCoeff() : std::numeric_limits<double>::infinity();
}

Recorder::Recorder(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task,
                   const VectorX& times)
    : dynamics_(arm), task_(task), still_(VectorX::Zero(arm->coordinates())) {
  const Eigen::Index count = times.size();
  replay_.times = times;
  replay_.position = replay_.rate = MatrixX(count, arm->coordinates());
  replay_.torque = MatrixX(count, arm->inputs());
  replay_.tip = replay_.tip_velocity = Points(count, 3);
  replay_.clearances = VectorX::Constant(static_cast<Eigen::Index>(task.obstacles.size()),
                                         std::numeric_limits<double>::infinity());
}

void Recorder::add(const VectorX& q, const VectorX& rate, const VectorX& torque) {
  const auto view = [](const VectorX& v) {
    return std::span<const double>(v.data(), static_cast<std::size_t>(v.size()));
  };
  replay_.position.row(next_) = q;
  replay_.rate.row(next_) = rate;
  replay_.torque.row(next_) = torque;
  dynamics_.set(view(q), view(rate), view(still_));
  const pcc::ArmPoint tip{dynamics_.arm().segments() - 1};
  const auto at = dynamics_.position(tip), speed = dynamics_.velocity(tip);
  replay_.tip.row(next_) << at.x, at.y, at.z;
  replay_.tip_velocity.row(next_) << speed.x, speed.y, speed.z;
  if (!task_.obstacles.empty()) lower(replay_.clearances, dynamics_, task_.obstacles);
  ++next_;
}

Replay Recorder::finish() {
  const Eigen::Index last = next_ - 1;
  replay_.tip_error = (replay_.tip.row(last).transpose() - task_.goal.position).norm();
  replay_.tip_speed = replay_.tip_velocity.row(last).norm();
  return std::move(replay_);
}

Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task, const Plan& plan,
              const VectorX& times) {
  // The torque of a drive is as smooth as cubics through its samples. The step-size control handles
  // it.
  const VectorX kinks = plan.knots.drive ? VectorX() : plan.knots.times;
  return replay_torque(
      arm, task, [&](double time) { return plan.torque(time); }, kinks, times);
}

Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task, const Plan& plan,
              double time_step) {
  return replay(arm, task, plan, equal_times(plan.duration(), time_step));
}

Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task, const DriveRun& run,
              double time_step) {
  check_channels(run.channels, arm->inputs(), run.lead, "drive run");
  return replay_torque(
      arm, task, [&](double time) { return run.torque(time - run.lead); }, {},
      equal_times(run.lead + task.grid.duration, time_step));
}

VectorX interval_defects(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& task,
                         const Plan& plan) {
  const Knots& knots = plan.knots;
  const double angle = task.goal.tolerance / arm->length(),
               rate = std::min(task.goal.speed_tolerance / arm->length(), kNoBound);
  pcc::AdaptiveMotion motion(arm);
  VectorX defects(knots.times.size() - 1);
  for (Eigen::Index k = 0; k < defects.size(); ++k) {
    motion.set_state(knots.position.row(k), knots.rate.row(k), knots.times[k]);
    motion.advance(knots.times[k + 1], [&](double time) { return plan.torque(time); });
    const VectorX position = motion.position() - knots.position.row(k + 1).transpose(),
                  speed = motion.rate() - knots.rate.row(k + 1).transpose();
    defects[k] = position.norm() / angle + speed.norm() / rate;
  }
  return defects;
}

}  // namespace sinew::plan
