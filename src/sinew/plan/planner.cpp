#include "sinew/plan/planner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/adaptive_motion.hpp"
#include "sinew/plan/drive_inversion.hpp"
#include "sinew/plan/mesh.hpp"
#include "sinew/plan/uniform.hpp"

namespace sinew::plan {

namespace {

/// Random torques: two sines per input, added to the initial torque.
class Excitation {
 public:
  Excitation(const PlanTask& task, double torque, double frequency, std::uint64_t seed)
      : task_(task) {
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
  const PlanTask& task_;
  MatrixX sizes_, frequencies_;  // N m, rad/s
};

/// The task without its drive, with torques limited by the volumes of the drive.
PlanTask without_drive(PlanTask task) {
  ArmLimits& limits = task.limits;
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

PlanStatus status_of(Status status) {
  switch (status) {
    case Status::solved:
      return PlanStatus::solved;
    case Status::acceptable:
      return PlanStatus::acceptable;
    case Status::infeasible:
      return PlanStatus::infeasible;
    case Status::iteration_limit:
      return PlanStatus::iteration_limit;
    case Status::time_limit:
      return PlanStatus::time_limit;
    case Status::failed:
      break;
  }
  return PlanStatus::failed;
}

}  // namespace

std::string_view status_name(PlanStatus status) {
  switch (status) {
    case PlanStatus::solved:
      return "solved";
    case PlanStatus::acceptable:
      return "acceptable";
    case PlanStatus::not_met_on_replay:
      return "not-met-on-replay";
    case PlanStatus::infeasible:
      return "infeasible";
    case PlanStatus::iteration_limit:
      return "iteration-limit";
    case PlanStatus::time_limit:
      return "time-limit";
    case PlanStatus::failed:
      break;
  }
  return "failed";
}

VectorX Plan::fractions() const {
  const Eigen::Index count = knots.times.size() - 1;
  return (knots.times.tail(count) - knots.times.head(count)) / duration();
}

VectorX Plan::torque(double time) const {
  if (knots.drive) return knots.drive->torque(std::clamp(time, 0.0, duration()));
  const VectorX& times = knots.times;
  // At a knot, also if rounded up, the interval is the one before it.
  const double rounding = 1e-12 * duration();
  const auto after = std::lower_bound(times.begin() + 1, times.end() - 1, time - rounding);
  const Eigen::Index k = after - times.begin();
  if (method == CollocationMethod::backward_euler) return knots.torque.row(k);
  const double fraction = std::clamp((time - times[k - 1]) / (times[k] - times[k - 1]), 0.0, 1.0);
  return (1.0 - fraction) * knots.torque.row(k - 1) + fraction * knots.torque.row(k);
}

Planner::Planner(std::shared_ptr<const pcc::Arm> arm, const PlanTask& task,
                 const PlannerSettings& settings)
    : arm_(std::move(arm)),
      asked_(completed(*arm_, task)),
      task_(asked_),
      settings_(settings),
      program_(std::make_unique<Collocation>(arm_, task_)),
      equations_(arm_) {}

Knots Planner::guess(std::uint64_t seed) const {
  const Grid& grid = asked_.grid;
  const Eigen::Index count = grid.intervals + 1, n = arm_->coordinates();
  // Frequency of the slow motion of the whole arm, like that of a pendulum, which a swing uses.
  pcc::ArmEquations equations(arm_);
  const auto& linear =
      equations.linearise(asked_.start.position, VectorX::Zero(n), VectorX::Zero(n));
  const double frequency =
      std::sqrt(linear.by_position.diagonal().cwiseAbs().sum() / linear.by_acceleration.trace());
  double torque = 0.0;
  for (const VectorX* limit : {&asked_.limits.torque_lower, &asked_.limits.torque_upper}) {
    for (const double value : *limit) {
      if (std::abs(value) < kNoBound) torque = std::max(torque, std::abs(value));
    }
  }
  if (torque == 0.0) torque = arm_->stiffness().maxCoeff();
  const Excitation excitation(asked_, torque, frequency, seed);
  pcc::AdaptiveMotion motion(arm_, {.relative = 1e-3, .angle = 1e-4, .rate = 1e-3});
  motion.set_state(asked_.start.position, asked_.start.rate);
  Knots knots{VectorX::Zero(count),
              MatrixX(count, n),
              MatrixX(count, n),
              MatrixX(count, n),
              MatrixX(count, arm_->inputs()),
              {}};
  for (Eigen::Index k = 0; k < count; ++k) {
    if (k > 0) {
      knots.times[k] = knots.times[k - 1] + grid.fractions[k - 1] * grid.duration;
      motion.advance(knots.times[k], excitation);
    }
    knots.position.row(k) = motion.position();
    knots.rate.row(k) = motion.rate();
    knots.torque.row(k) = excitation(knots.times[k]);
  }
  knots.acceleration = slopes(knots.times, knots.rate);
  return knots;
}

void Planner::set_mesh(const VectorX& fractions) {
  if (fractions.size() == task_.grid.fractions.size() &&
      (fractions - task_.grid.fractions).lpNorm<Eigen::Infinity>() < 1e-12) {
    return;
  }
  task_.grid.fractions = fractions;
  task_.grid.intervals = static_cast<int>(fractions.size());
  program_ = std::make_unique<Collocation>(arm_, task_);
}

double Planner::time_left() const {
  const double spent = static_cast<double>(std::clock() - begun_) / CLOCKS_PER_SEC;
  return settings_.solver.max_time - spent;
}

Plan Planner::solve_program(const ProgramPoint& start) {
  SolverSettings settings = settings_.solver;
  settings.max_time = std::max(time_left(), 1e-3);
  ProgramResult result = solve(*program_, start, settings);
  Plan plan{status_of(result.status), task_.grid.method, program_->unpack(result.point.x),
            result.objective};
  plan.iterations = result.iterations;
  plan.seconds = result.seconds;
  plan.point = std::move(result.point);
  plan.aim = program_->aim();
  return plan;
}

ProgramPoint Planner::cold_start(std::uint64_t seed) {
  return {program_->pack(guess(seed)), {}, {}, {}};
}

ProgramPoint Planner::drive_start(std::uint64_t seed) {
  Planner torques(arm_, without_drive(asked_), settings_);
  torques.begun_ = begun_;
  Plan before = torques.solve_program(torques.cold_start(seed));
  before_iterations_ = before.iterations;
  before_seconds_ = before.seconds;
  const auto& [channels, lead] = *task_.drive;
  VectorX rest(task_.start.torque.size());
  for (Eigen::Index i = 0; i < rest.size(); ++i) {
    const auto& [actuator, cylinder] = channels[static_cast<std::size_t>(i)];
    rest[i] = actuator.volume(task_.start.torque[i]) / cylinder.gain();
  }
  before.knots.drive.emplace(channels, invert_drive(before, channels, lead).command, lead, rest);
  // All rows except those of the drive are rows of the plan of torques.
  const VectorX none = VectorX::Zero(program_->variables());
  ProgramPoint start{program_->pack(before.knots), VectorX::Zero(program_->constraints()), none,
                     none};
  const VectorX& multipliers = before.point.constraint_multipliers;
  start.constraint_multipliers.head(multipliers.size()) = multipliers;
  return start;
}

Plan Planner::plan(std::uint64_t seed) {
  begun_ = std::clock();
  set_mesh(asked_.grid.fractions);
  program_->set_aim({.clearance = VectorX::Zero(obstacles())});
  return solve_verified(task_.drive ? drive_start(seed) : cold_start(seed));
}

Plan Planner::plan(const Knots& guess) {
  if (task_.drive && !guess.drive) {
    throw Error(ErrorKind::wrong_length, {.item = "guess"}, "it has no commands of the drive",
                "give them, or a seed");
  }
  if (guess.times.size() != asked_.grid.intervals + 1) {
    throw Error(ErrorKind::wrong_length, {.item = "guess"},
                fmt::format("it has {} knots", guess.times.size()),
                fmt::format("give {}, one more than intervals", asked_.grid.intervals + 1));
  }
  begun_ = std::clock();
  set_mesh(asked_.grid.fractions);
  program_->set_aim({.clearance = VectorX::Zero(obstacles())});
  return solve_verified({program_->pack(guess), {}, {}, {}});
}

Plan Planner::replan(const Plan& before) {
  begun_ = std::clock();
  if (before.knots.times.size() > 1) set_mesh(before.fractions());
  if (before.point.x.size() != program_->variables() ||
      before.point.constraint_multipliers.size() != program_->constraints() ||
      before.aim.clearance.size() != obstacles()) {
    throw Error(ErrorKind::wrong_length, {.item = "before"},
                fmt::format("it has {} unknowns and {} conditions, and this task on its knots has "
                            "{} and {}",
                            before.point.x.size(), before.point.constraint_multipliers.size(),
                            program_->variables(), program_->constraints()),
                "replan with the same method and kinds of limits");
  }
  program_->set_aim(before.aim);
  return solve_verified(before.point);
}

}  // namespace sinew::plan
