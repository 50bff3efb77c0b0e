#include "sinew/plan/planner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/arm_simulation.hpp"
#include "sinew/plan/drive_inversion.hpp"
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

/// The task in torques alone, within what the drives' volumes allow.
Task without_drive(Task task) {
  Limits& limits = task.limits;
  for (std::size_t i = 0; i < task.drive->channels.size(); ++i) {
    const auto& [actuator, cylinder] = task.drive->channels[i];
    const auto u = static_cast<Eigen::Index>(i);
    if (std::isfinite(cylinder.lowest_volume)) {
      limits.torque_lower[u] =
          std::max(limits.torque_lower[u], actuator.torque(cylinder.lowest_volume));
    }
    if (std::isfinite(cylinder.highest_volume)) {
      limits.torque_upper[u] =
          std::min(limits.torque_upper[u], actuator.torque(cylinder.highest_volume));
    }
  }
  task.drive.reset();
  return task;
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
  const int steps = std::max(1, static_cast<int>(std::ceil(h / 0.005)));
  pcc::ArmSimulation simulation(arm_, {.time_step = h / steps});
  simulation.set_state(task_.start.position, task_.start.rate);
  Knots knots{VectorX::LinSpaced(count, 0.0, grid.duration),
              MatrixX(count, n),
              MatrixX(count, n),
              MatrixX(count, n),
              MatrixX(count, arm_->inputs()),
              {}};
  for (Eigen::Index k = 0; k < count; ++k) {
    for (int s = 0; k > 0 && s < steps; ++s) {
      simulation.step(excitation(simulation.time() + h / steps));
    }
    knots.position.row(k) = simulation.position();
    knots.rate.row(k) = simulation.rate();
    knots.torque.row(k) = excitation(knots.times[k]);
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

Plan Planner::plan(std::uint64_t seed) {
  return task_.drive ? plan_drive(seed) : plan(guess(seed));
}

Plan Planner::plan_drive(std::uint64_t seed) {
  Plan before = Planner(arm_, without_drive(task_), settings_).plan(seed);
  const auto& [channels, lead] = *task_.drive;
  VectorX rest(task_.start.torque.size());
  for (Eigen::Index i = 0; i < rest.size(); ++i) {
    const auto& [actuator, cylinder] = channels[static_cast<std::size_t>(i)];
    rest[i] = actuator.volume(task_.start.torque[i]) / cylinder.gain();
  }
  before.knots.drive.emplace(channels, invert_drive(before, channels, lead).command, lead, rest);
  // All rows but the drive's are those of the plan of torques.
  const VectorX none = VectorX::Zero(program_.variables());
  ProgramPoint start{program_.pack(before.knots), VectorX::Zero(program_.constraints()), none,
                     none};
  const VectorX& multipliers = before.point.constraint_multipliers;
  start.constraint_multipliers.head(multipliers.size()) = multipliers;
  Plan found = finish(solve(program_, start, settings_));
  found.iterations += before.iterations;
  found.seconds += before.seconds;
  return found;
}

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
