// Simulation::solve_static: Newton with the exact tangent and the cables' geometric stiffness, in
// one go or, where that fails, along the path on which the imbalance of the start is taken away bit
// by bit: r(q, lambda) = (1 - s) r_start, s from 0 to 1 (a convex homotopy; Allgower & Georg
// 1990, 1.3).

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

namespace {

// A chamber is near its limit point where pressure rises by less than the inverse of this for what
// it rose by the same volume before.
constexpr double kFlat = 5.0;

// Touching points are this near their surface, of the robot's size.
constexpr double kSurfaceTolerance = 1e-9;
constexpr int kMostSurfaceRounds = 60;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Commands on the way from where the actuators stand (share 1) to where they are told to be (0).
void blend(std::span<ActuatorRange> ranges, std::span<const ActuatorState> start,
           std::span<const ActuatorRange> goal, double share) {
  for (std::size_t i = 0; i < start.size(); ++i) {
    const double from = goal[i].kind == CommandKind::effort ? start[i].effort : start[i].motion;
    ranges[i] = goal[i];
    if (goal[i].kind == CommandKind::input) continue;  // the imbalance alone is taken away
    ranges[i].value = share * from + (1.0 - share) * goal[i].value;
    ranges[i].drive_step.command = ranges[i].value;
  }
}

}  // namespace

NewtonReport Simulation::equilibrate(const StaticSettings& settings, double share,
                                     StaticReport& report) {
  world_.set_imbalance_share(share);
  world_.begin_step(time(), time(), effort_);
  const LawProblem problem = world_.law_problem(ranges_, time(), kInfinity);
  const NewtonSettings newton{{{}, mechanics::Tangent::exact, true, true},
                              settings.tolerance,
                              settings.tolerance,
                              settings.max_iterations,
                              model_->curved_constraints()};
  const NewtonReport result =
      solve_newton(world_, complete(nullptr), problem, effort_, newton, clock_);
  report.iterations += result.iterations;
  report.status = result.status;
  report.residual = result.residual;
  report.relative_residual = result.relative_residual;
  report.violation = result.violation;
  return result;
}

// At the last equilibrium that was found: a chamber whose pressure hardly rises any more while its
// volume grows, compared with how it did on the average so far.
std::string Simulation::describe_limit_point() {
  world_.set_imbalance_share(0.0);
  world_.linearise({{}, mechanics::Tangent::exact, true, true});
  world_.form_rows(effort_, model_->curved_constraints());
  if (world_.condense() == linalg::FactorStatus::singular) return {};
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    const ActuatorModel& model = model_->actuators()[i];
    const ActuatorRange& range = ranges_[i];
    if (model.type != ActuatorType::pressure || range.kind != CommandKind::effort) continue;
    const double reached = effort_[static_cast<std::size_t>(model.row)];
    const double grown = world_.delta()[model.row];
    const double compliance = world_.compliance()(model.row, model.row);
    const bool flat = compliance < 0.0 || compliance * reached > kFlat * grown;
    const bool short_of = std::abs(reached) < std::abs(range.value);
    if (!(reached * grown > 0.0) || !flat || !short_of) continue;
    return fmt::format(
        "chamber '{}' has no equilibrium at {:.4g} kPa: about {:.4g} kPa its "
        "pressure reaches a peak (limit point), where it has grown by {:.4g} ml",
        model.name, 1e-3 * range.value, 1e-3 * reached, 1e6 * grown);
  }
  return {};
}

// A step takes surfaces for their tangent planes: further ones until no touching point finds its
// own another.
void Simulation::follow_surfaces(const StaticSettings& settings, StaticReport& report,
                                 NewtonReport& last) {
  const double tolerance = std::max(settings.tolerance, kSurfaceTolerance) * model_->size();
  for (int round = 0; round < kMostSurfaceRounds; ++round) {
    if (!(world_.contact_drift(effort_, time()) > tolerance)) return;
    last = equilibrate(settings, 0.0, report);
    if (last.status != NewtonStatus::converged) break;
  }
  if (world_.contact_drift(effort_, time()) > tolerance || last.status != NewtonStatus::converged) {
    fail(ErrorKind::not_converged, "points keep moving along a curved surface",
         "approach the load through time steps");
  }
}

StaticReport Simulation::solve_static(const StaticSettings& settings) {
  StaticReport report;
  clock_.start();
  now_ = time();
  move_bases(now_);
  set_loads(now_);
  save_state(state_before_);
  const std::vector<ActuatorState> start = actuators_;
  read_ranges(time(), kInfinity);
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    if (!ranges_[i].owned) continue;
    ranges_[i].kind = CommandKind::effort;
    ranges_[i].value = actuators_[i].effort;
    ranges_[i].motion_min = -kInfinity;
    ranges_[i].motion_max = kInfinity;
  }
  const std::vector<ActuatorRange> goal = ranges_;
  direct_.reset();
  contact_.reset();
  NewtonReport last = equilibrate(settings, 0.0, report);

  if (last.status != NewtonStatus::converged) {
    load_state(state_before_, steps_);
    world_.linearise({{}, mechanics::Tangent::exact, true, true});
    world_.form_rows(effort_, model_->curved_constraints());
    world_.hold_imbalance(effort_);
    std::vector<double> sound = state_before_;
    double share = 1.0;
    double part = 0.25;
    report.load_steps = 0;
    while (share > 0.0 && part * settings.max_load_steps >= 1.0) {
      const double next = std::max(0.0, share - part);
      blend(ranges_, start, goal, next);
      last = equilibrate(settings, next, report);
      if (last.status == NewtonStatus::converged) {
        share = next;
        part *= 2.0;
        ++report.load_steps;
        save_state(sound);
      } else {
        load_state(sound, steps_);
        part *= 0.5;
      }
    }
    world_.set_imbalance_share(0.0);
  }
  if (last.status != NewtonStatus::converged) {
    const std::string limit = describe_limit_point();
    if (!limit.empty()) {
      fail(ErrorKind::not_converged, limit,
           "command its volume_growth, which passes the peak, or follow_path()");
    }
    fail(ErrorKind::not_converged,
         fmt::format("no static equilibrium was found: Newton ended as '{}' with a relative "
                     "residual of {:.3g}, in load steps down to 1/{}",
                     newton_status_name(last.status), last.relative_residual,
                     settings.max_load_steps),
         "approach the load through time steps; the robot may buckle on the way");
  }
  follow_surfaces(settings, report, last);
  volume_ratio_ = last.motion.smallest_volume_ratio;
  ranges_ = goal;
  world_.begin_step(time(), time(), effort_);
  world_.end_step({});
  step_before_ = 0.0;
  finish_step();
  advance_drives();
  return report;
}

}  // namespace sinew::sim
