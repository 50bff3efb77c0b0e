#include "sinew/plan/replay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "sinew/pcc/arm_simulation.hpp"

namespace sinew::plan {

namespace {

/// Least distance of the arm's axis from the obstacles.
double clearance(const pcc::ArmDynamics<double>& dynamics, const std::vector<Obstacle>& obstacles) {
  constexpr int kPoints = 20;  // a segment
  double least = std::numeric_limits<double>::infinity();
  for (int s = 0; s < dynamics.arm().segments(); ++s) {
    for (int i = 0; i <= kPoints; ++i) {
      const pcc::Vec3<double> at = dynamics.position({s, static_cast<double>(i) / kPoints});
      for (const Obstacle& obstacle : obstacles) {
        least = std::min(least, obstacle.distance({at.x, at.y, at.z}));
      }
    }
  }
  return least;
}

template <typename Torque>
Replay replay_torque(const std::shared_ptr<const pcc::Arm>& arm, const Task& task_given,
                     const Torque& torque_at, double duration, double time_step) {
  const Task task = completed(*arm, task_given);
  const auto count = static_cast<Eigen::Index>(std::max(1.0, std::round(duration / time_step)));
  const double h = duration / static_cast<double>(count);
  pcc::ArmSimulation simulation(arm, {.time_step = h});
  simulation.set_state(task.start.position, task.start.rate);
  Recorder recorder(arm, task, count, h);
  recorder.add(simulation.position(), simulation.rate(), torque_at(0.0));
  for (Eigen::Index k = 1; k <= count; ++k) {
    const VectorX torque = torque_at(static_cast<double>(k) * h);
    simulation.step(torque);
    recorder.add(simulation.position(), simulation.rate(), torque);
  }
  return recorder.finish();
}

}  // namespace

Recorder::Recorder(const std::shared_ptr<const pcc::Arm>& arm, const Task& task, Eigen::Index steps,
                   double time_step)
    : dynamics_(arm), task_(task), still_(VectorX::Zero(arm->coordinates())) {
  const Eigen::Index count = steps + 1;
  replay_.times = VectorX::LinSpaced(count, 0.0, static_cast<double>(steps) * time_step);
  replay_.position = replay_.rate = MatrixX(count, arm->coordinates());
  replay_.torque = MatrixX(count, arm->inputs());
  replay_.tip = replay_.tip_velocity = Points(count, 3);
  replay_.clearance = std::numeric_limits<double>::infinity();
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
  if (!task_.obstacles.empty()) {
    replay_.clearance = std::min(replay_.clearance, clearance(dynamics_, task_.obstacles));
  }
  ++next_;
}

Replay Recorder::finish() {
  const Eigen::Index last = next_ - 1;
  replay_.tip_error = (replay_.tip.row(last).transpose() - task_.goal.position).norm();
  replay_.tip_speed = replay_.tip_velocity.row(last).norm();
  return std::move(replay_);
}

Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const Task& task, const Plan& plan,
              double time_step) {
  return replay_torque(
      arm, task, [&](double time) { return plan.torque(time); }, plan.duration(), time_step);
}

Replay replay(const std::shared_ptr<const pcc::Arm>& arm, const Task& task, const DriveRun& run,
              double time_step) {
  check_channels(run.channels, arm->inputs(), run.lead, "drive run");
  return replay_torque(
      arm, task, [&](double time) { return run.torque(time - run.lead); },
      run.lead + task.grid.duration, time_step);
}

}  // namespace sinew::plan
