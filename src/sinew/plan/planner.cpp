#include "sinew/plan/planner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/arm_simulation.hpp"
#include "sinew/plan/uniform.hpp"

namespace sinew::plan {

namespace {

/// Random torques: two sines an input, that begin at the start's torque.
class Excitation {
 public:
  Excitation(const Task& task, double torque, double frequency, std::uint64_t seed) : task_(task) {
    Uniform uniform(seed);
    const Eigen::Index inputs = task.start.torque.size();
    for (auto* part : {&sizes_, &frequencies_}) part->resize(inputs, kSines);
    for (Eigen::Index u = 0; u < inputs; ++u) {
      for (Eigen::Index s = 0; s < kSines; ++s) {
        sizes_(u, s) = torque * uniform(-0.5, 0.5);
        frequencies_(u, s) = frequency * uniform(0.5, 2.0);
      }
    }
  }

  VectorX operator()(double time) const {
    VectorX torque = task_.start.torque;
    for (Eigen::Index u = 0; u < torque.size(); ++u) {
      for (Eigen::Index s = 0; s < kSines; ++s) {
        torque[u] += sizes_(u, s) * std::sin(frequencies_(u, s) * time);
      }
    }
    return torque.cwiseMax(task_.limits.torque_lower).cwiseMin(task_.limits.torque_upper);
  }

 private:
  static constexpr Eigen::Index kSines = 2;
  const Task& task_;
  MatrixX sizes_, frequencies_;  // N m, rad/s
};

/// What the drive makes of commands that would give the torques at rest.
DriveRun driven(const Task& task, const Excitation& wanted) {
  const auto& [channels, lead] = *task.drive;
  const double step = channels.front().cylinder.sample_time;
  const auto inputs = static_cast<Eigen::Index>(channels.size());
  MatrixX command(sample_count(channels.front().cylinder, lead + task.grid.duration), inputs);
  VectorX rest(inputs);
  for (Eigen::Index i = 0; i < inputs; ++i) {
    const auto& [actuator, cylinder] = channels[static_cast<std::size_t>(i)];
    rest[i] = actuator.volume(task.start.torque[i]) / cylinder.gain();
    for (Eigen::Index k = 0; k < command.rows(); ++k) {
      const double time = static_cast<double>(k) * step + actuator.delay - lead;
      const double volume = actuator.volume(wanted(std::max(time, 0.0))[i]);
      command(k, i) = std::clamp(volume / cylinder.gain(), cylinder.lowest_input,
                                 cylinder.highest_input);
    }
  }
  return {channels, std::move(command), lead, std::move(rest)};
}

}  // namespace

VectorX Plan::torque(double time) const {
  if (knots.drive) return knots.drive->torque(std::clamp(time, 0.0, duration()));
  const Eigen::Index last = knots.times.size() - 1;
  const double at = std::clamp(time / duration(), 0.0, 1.0) * static_cast<double>(last);
  const double rounding = 1e-9;
  if (method == Method::backward_euler) {
    const auto k = static_cast<Eigen::Index>(std::ceil(at - rounding));
    return knots.torque.row(std::clamp<Eigen::Index>(k, 1, last));
  }
  const auto k = std::min(static_cast<Eigen::Index>(at), last - 1);
  const double share = at - static_cast<double>(k);
  return (1.0 - share) * knots.torque.row(k) + share * knots.torque.row(k + 1);
}

Planner::Planner(std::shared_ptr<const pcc::Arm> arm, const Task& task,
                 const SolverSettings& settings)
    : arm_(std::move(arm)),
      task_(completed(*arm_, task)),
      settings_(settings),
      program_(arm_, task_),
      equations_(arm_) {}

Knots Planner::guess(std::uint64_t seed) const {
  const Grid& grid = task_.grid;
  const double h = grid.duration / grid.intervals;
  const Eigen::Index count = grid.intervals + 1, n = arm_->coordinates();
  // The slow motion of the whole arm, as a pendulum of its mass: what a swing works with.
  pcc::ArmEquations equations(arm_);
  const auto& linear =
      equations.linearise(task_.start.position, VectorX::Zero(n), VectorX::Zero(n));
  const double frequency =
      std::sqrt(linear.by_position.diagonal().cwiseAbs().sum() / linear.by_acceleration.trace());
  double torque = 0.0;
  for (const VectorX* limit : {&task_.limits.torque_lower, &task_.limits.torque_upper}) {
    for (const double value : *limit) {
      if (std::abs(value) < kNoBound) torque = std::max(torque, std::abs(value));
    }
  }
  if (torque == 0.0) torque = arm_->stiffness().maxCoeff();
  const Excitation excitation(task_, torque, frequency, seed);
  std::optional<DriveRun> drive;
  if (task_.drive) drive.emplace(driven(task_, excitation));
  const auto torque_at = [&](double time) {
    return drive ? drive->torque(time) : excitation(time);
  };
  const int steps = std::max(1, static_cast<int>(std::ceil(h / 0.005)));
  pcc::ArmSimulation simulation(arm_, {.time_step = h / steps});
  simulation.set_state(task_.start.position, task_.start.rate);
  Knots knots{VectorX::LinSpaced(count, 0.0, grid.duration), MatrixX(count, n), MatrixX(count, n),
              MatrixX(count, n), MatrixX(count, arm_->inputs()), drive};
  for (Eigen::Index k = 0; k < count; ++k) {
    for (int s = 0; k > 0 && s < steps; ++s) {
      simulation.step(torque_at(simulation.time() + h / steps));
    }
    knots.position.row(k) = simulation.position();
    knots.rate.row(k) = simulation.rate();
    knots.torque.row(k) = torque_at(knots.times[k]);
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index from = std::max<Eigen::Index>(k - 1, 0), to = std::min(k + 1, count - 1);
    knots.acceleration.row(k) =
        (knots.rate.row(to) - knots.rate.row(from)) / (static_cast<double>(to - from) * h);
  }
  return knots;
}

Plan Planner::finish(ProgramResult result) {
  Plan plan{result.status, task_.grid.method, program_.unpack(result.point.x), result.objective};
  const Eigen::Index last = plan.knots.times.size() - 1;
  const VectorX q = plan.knots.position.row(last), rate = plan.knots.rate.row(last);
  const auto tip = equations_.point({arm_->segments() - 1}, q, rate);
  plan.tip_error = (tip.position - task_.goal.position).norm();
  plan.tip_speed = (tip.jacobian * rate).norm();
  plan.iterations = result.iterations;
  plan.seconds = result.seconds;
  plan.point = std::move(result.point);
  return plan;
}

Plan Planner::plan(std::uint64_t seed) { return plan(guess(seed)); }

Plan Planner::plan(const Knots& guess) {
  if (task_.drive && !guess.drive) {
    throw Error(ErrorKind::wrong_length, {.item = "guess"}, "it has no commands of the drive",
                "give them, or a seed");
  }
  return finish(solve(program_, {program_.pack(guess), {}, {}, {}}, settings_));
}

Plan Planner::replan(const Plan& before) {
  if (before.point.x.size() != program_.variables() ||
      before.point.constraint_multipliers.size() != program_.constraints()) {
    throw Error(ErrorKind::wrong_length, {.item = "before"},
                fmt::format("it has {} unknowns and this task has {}", before.point.x.size(),
                            program_.variables()),
                "replan with the same method, intervals and kinds of limits");
  }
  return finish(solve(program_, before.point, settings_));
}

}  // namespace sinew::plan
