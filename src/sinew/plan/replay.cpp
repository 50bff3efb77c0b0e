#include "sinew/plan/replay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sinew/pcc/arm_simulation.hpp"

namespace sinew::plan {

namespace {

/// Least distance of the arm's axis from the obstacles, over and above what is to be left.
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

}  // namespace

Replay replay(std::shared_ptr<const pcc::Arm> arm, const Task& task_given, const Plan& plan,
              double time_step) {
  const Task task = completed(*arm, task_given);
  const auto count =
      static_cast<Eigen::Index>(std::max(1.0, std::round(plan.duration() / time_step)));
  const double h = plan.duration() / static_cast<double>(count);
  pcc::ArmSimulation simulation(arm, {.time_step = h});
  pcc::ArmDynamics<double> dynamics(arm);
  simulation.set_state(task.start.position, task.start.rate);
  const Eigen::Index n = arm->coordinates();
  Replay result{VectorX::LinSpaced(count + 1, 0.0, plan.duration()), MatrixX(count + 1, n),
                MatrixX(count + 1, n), MatrixX(count + 1, arm->inputs()), Points(count + 1, 3),
                Points(count + 1, 3)};
  result.clearance = std::numeric_limits<double>::infinity();
  const VectorX still = VectorX::Zero(n);
  const auto view = [n](const VectorX& v) {
    return std::span<const double>(v.data(), static_cast<std::size_t>(n));
  };
  for (Eigen::Index k = 0; k <= count; ++k) {
    result.torque.row(k) = plan.torque(result.times[k]);
    if (k > 0) simulation.step(result.torque.row(k).transpose());
    result.position.row(k) = simulation.position();
    result.rate.row(k) = simulation.rate();
    dynamics.set(view(simulation.position()), view(simulation.rate()), view(still));
    const pcc::ArmPoint tip{arm->segments() - 1};
    const auto at = dynamics.position(tip), speed = dynamics.velocity(tip);
    result.tip.row(k) << at.x, at.y, at.z;
    result.tip_velocity.row(k) << speed.x, speed.y, speed.z;
    result.clearance = std::min(result.clearance, clearance(dynamics, task.obstacles));
  }
  result.tip_error = (result.tip.row(count).transpose() - task.goal.position).norm();
  result.tip_speed = result.tip_velocity.row(count).norm();
  return result;
}

}  // namespace sinew::plan
