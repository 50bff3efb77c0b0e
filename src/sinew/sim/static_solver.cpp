#include "sinew/sim/static_solver.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/sim/load_steps.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/stability.hpp"
#include "sinew/sim/step_failure.hpp"

namespace sinew::sim {

namespace {

// A chamber is near its limit point if its pressure increases per volume by less than the inverse
// of this, relative to its mean increase so far.
constexpr double kFlat = 5.0;

// Tolerance on the gaps of touching points, relative to the robot's size.
constexpr double kSurfaceTolerance = 1e-9;
constexpr int kMaxSurfaceRounds = 60;

// Maximum number of unstable equilibria that are left in succession, and the disturbances, relative
// to the robot's size, which increase each time.
constexpr int kMaxDepartures = 6;
constexpr double kDisturbance = 1e-2;
constexpr double kLargerDisturbance = 2.0;

}  // namespace

StaticSolver::StaticSolver(Run& run, const StaticSettings& settings)
    : run_(run),
      settings_(settings),
      search_(run, settings),
      motion_(search_),
      report_(search_.report()) {}

StaticReport StaticSolver::run() {
  run_.clock.start();
  run_.watch.begin();
  run_.now = run_.time();
  run_.surroundings.move_bases(run_.now);
  run_.surroundings.apply(run_.now);
  run_.keep(run_.before);
  try {
    search();
  } catch (...) {  // failures have restored the state already; exceptions of a watcher have not
    run_.go_back();
    throw;
  }
  const NewtonReport& last = search_.last();
  report_.status = last.status;
  report_.residual = last.residual;
  report_.relative_residual = last.relative_residual;
  report_.violation = last.violation;
  run_.volume_ratio = last.motion.volume.ratio;
  run_.world.problem().actuators = goal_;
  search_.begin();
  run_.world.bodies().end_step({});
  run_.forget_history();
  run_.ledger.restart();
  run_.finish_step();
  run_.actuation.advance_drives(run_.world.problem().actuators);
  return report_;
}

void StaticSolver::search() {
  read_goal();
  if (limits_motors(*run_.model, goal_) && find_without_limits()) return;
  find();
}

// See lift_motor_limits().
bool StaticSolver::find_without_limits() {
  std::vector<step::ActuatorBlock>& blocks = run_.world.problem().actuators;
  const std::vector<step::ActuatorBlock> limited = goal_;
  lift_motor_limits(*run_.model, goal_);
  blocks = goal_;
  bool found = true;
  try {
    find();
  } catch (const Error& failure) {
    if (!failure.is_run_failure()) throw;
    found = false;
  }
  blocks = goal_ = limited;
  if (found && keeps_motor_limits(*run_.model, goal_, run_.effort)) return true;
  run_.restore(run_.before);
  return false;
}

void StaticSolver::find() {
  if (!search_.equilibrate(0.0)) approach();
  follow_surfaces();
  settle();
}

void StaticSolver::read_goal() {
  start_ = run_.actuation.states();
  run_.read_commands(run_.time(), kInfinity);
  hold_efforts(run_.world.problem().actuators, run_.effort);
  goal_ = run_.world.problem().actuators;
  run_.solver.begin_step();
}

// Interpolates commands between the actuators' values at the start (fraction 1) and the goal (0).
void StaticSolver::blend(double fraction) {
  run_.world.problem().actuators = goal_;
  sim::blend(run_.world.problem().actuators, start_, 1.0 - fraction);
}

// Applies load steps, then overdamped motion.
void StaticSolver::approach() {
  const double fraction = step_load();
  if (fraction == 0.0) return;
  const std::string known = describe(fraction);
  blend(0.0);
  run_.world.homotopy().set_fraction(0.0);
  const JointConflict conflict = find_conflict();
  if (!limit_point_ && motion_.relax_from_here()) return;
  if (!limit_point_ && !conflict.text.empty()) fail_joints(run_, conflict);
  fail_to_find(known);
}

// Uses the last equilibrium of the path, as condensed by describe(), with the full commands.
JointConflict StaticSolver::find_conflict() const {
  if (run_.world.inertia().status == linalg::FactorStatus::singular) return {};
  return find_joint_conflict(run_.world, kSurfaceTolerance * run_.model->size());
}

// @return the remaining fraction of the residual.
double StaticSolver::step_load() {
  run_.watch.enter(SearchStage::parts);
  run_.restore(run_.before);
  search_.linearise({});
  run_.world.homotopy().keep_residual(run_.effort);
  State sound = run_.before;  // of the last equilibrium
  report_.load_steps = 0;
  const auto solve = [&](double fraction) {
    blend(fraction);
    return search_.equilibrate(fraction);
  };
  const auto keep = [&] {
    ++report_.load_steps;
    run_.keep(sound);
  };
  return take_load_steps({.min = 1.0 / settings_.max_load_steps}, solve, keep,
                         [&] { run_.restore(sound); });
}

// Describes the last equilibrium of the path, which is the world's present state.
std::string StaticSolver::describe(double fraction) {
  search_.begin();
  run_.world.homotopy().set_fraction(fraction);
  search_.linearise({});
  if (run_.world.condense() == linalg::FactorStatus::singular) {
    return "the exact tangent of the last equilibrium on the way is singular";
  }
  std::string limit = describe_limit_point();
  if (!limit.empty() || fraction == 1.0) return limit;
  const int negative = Stability(run_.world, run_.effort).negative_pivots();
  const double percent = 100.0 * (1.0 - fraction);
  if (negative == 0) {
    return fmt::format("the last equilibrium on the way, at {:.3g} % of the load, is stable",
                       percent);
  }
  return fmt::format(
      "on the way to {:.3g} % of the load {} eigenvalue{} of the exact tangent passed zero: the "
      "robot buckles there",
      percent, negative, negative == 1 ? "" : "s");
}

// Describes a chamber whose pressure hardly increases with its volume any more, compared with its
// mean increase so far, in the condensed equilibrium.
std::string StaticSolver::describe_limit_point() {
  for (std::size_t i = 0; i < start_.size(); ++i) {
    const ActuatorModel& model = run_.model->actuators()[i];
    const step::ActuatorBlock& goal = goal_[i];
    if (model.type != ActuatorType::chamber || goal.kind != CommandKind::effort) continue;
    const double reached = run_.effort[static_cast<std::size_t>(model.row)];
    const double grown = run_.world.delta()[model.row];
    const double compliance = run_.world.problem().compliance(model.row, model.row);
    const bool flat = compliance < 0.0 || compliance * reached > kFlat * grown;
    const bool short_of = std::abs(reached) < std::abs(goal.value);
    if (!(reached * grown > 0.0) || !flat || !short_of) continue;
    limit_point_ = true;
    return fmt::format(
        "chamber '{}' has no equilibrium at {:.4g} kPa: about {:.4g} kPa its "
        "pressure reaches a peak (limit point), where it has grown by {:.4g} ml",
        model.name, 1e-3 * goal.value, 1e-3 * reached, 1e6 * grown);
  }
  return {};
}

void StaticSolver::fail_to_find(const std::string& known) {
  if (limit_point_) {
    fail(run_, ErrorKind::not_converged, known,
         "command its volume_growth, which passes the peak, or follow_path()");
  }
  fail(run_, ErrorKind::not_converged,
       fmt::format("no static equilibrium was found in load steps down to 1/{} and {} steps of "
                   "overdamped motion: Newton ended as '{}' with a relative residual of "
                   "{:.3g}{}{}",
                   settings_.max_load_steps, report_.relaxation_steps,
                   newton_status_name(search_.last().status), search_.last().relative_residual,
                   known.empty() ? "" : "; ", known),
       "approach the load through time steps, which show where the robot goes");
}

// Each solution replaces surfaces by their tangent planes: repeats it with updated planes until the
// plane of no touching point changes.
void StaticSolver::follow_surfaces() {
  const double tolerance = std::max(settings_.tolerance, kSurfaceTolerance) * run_.model->size();
  ContactPlanes& planes = run_.world.contacts().planes();
  const auto off = [&] { return planes.drift(run_.effort, run_.time()) > tolerance; };
  for (int round = 0; round < kMaxSurfaceRounds; ++round) {
    if (!off()) return;
    if (!search_.equilibrate(0.0)) break;
  }
  if (off() || search_.last().status != NewtonStatus::converged) {
    fail(run_, ErrorKind::not_converged, "points keep moving along a curved surface",
         "approach the load through time steps");
  }
}

// Moves from the present linearised equilibrium to a stable one.
void StaticSolver::settle() {
  double disturbance = kDisturbance;
  for (int departures = 0;; ++departures) {
    // Needs the tangent at this state, not at the last iterate.
    search_.begin();
    search_.linearise({});
    report_.stable = true;
    report_.negative_pivots = 0;
    if (run_.world.condense() == linalg::FactorStatus::singular) return;  // neutral
    const bool unsymmetric = run_.world.inertia().unsymmetric;
    const Stability stability(run_.world, run_.effort);
    report_.negative_pivots = stability.negative_pivots();
    report_.stable = report_.negative_pivots == 0;
    if (report_.stable || settings_.stability == StabilityChoice::any) return;
    const auto ended = departures < kMaxDepartures ? motion_.leave(stability, disturbance)
                                                   : OverdampedMotion::End::failed;
    if (ended == OverdampedMotion::End::failed) {
      fail(run_, ErrorKind::not_converged,
           fmt::format("the equilibrium is unstable in {} direction{} (negative pivots of the "
                       "exact tangent), and none that is stable was found from it in {} steps "
                       "of overdamped motion",
                       report_.negative_pivots, report_.negative_pivots == 1 ? "" : "s",
                       report_.relaxation_steps),
           "approach the load through time steps, or ask for any equilibrium, stable or not");
    }
    // With a potential, the motion cannot return by itself: a step was too long.
    if (ended == OverdampedMotion::End::returned && unsymmetric) {
      report_.stable = true;
      return;
    }
    if (ended == OverdampedMotion::End::arrived) follow_surfaces();
    disturbance *= kLargerDisturbance;
  }
}

}  // namespace sinew::sim
