#include "sinew/statics/static_solver.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/run/load_steps.hpp"
#include "sinew/run/run.hpp"
#include "sinew/statics/homotopy_path.hpp"
#include "sinew/statics/limit_point.hpp"
#include "sinew/statics/step_failure.hpp"
#include "sinew/world/stability.hpp"

namespace sinew::statics {

namespace {

// Load steps are halved to this fraction, after which arc length takes over where it can.
constexpr double kSmallestBeforePath = 1.0 / 16.0;
// Tolerance of the equilibria on the way, relative to the loads.
constexpr double kPathTolerance = 1e-9;

constexpr const char* kNoEquilibrium =
    "no static equilibrium was found, since nothing holds a part";

// Tolerance on the gaps of joints, relative to the robot's size.
constexpr double kJointTolerance = 1e-9;

}  // namespace

StaticSolver::StaticSolver(run::Run& run, const StaticSettings& settings)
    : run_(run),
      settings_(settings),
      search_(run, settings),
      motion_(search_),
      settling_(search_, motion_),
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
  const run::NewtonReport& last = search_.last();
  report_.status = last.status;
  report_.residual = last.residual;
  report_.relative_residual = last.relative_residual;
  report_.violation = last.violation;
  run_.volume_ratio = last.motion.volume.ratio;
  run_.world.problem().actuators = goal_;
  search_.begin();
  run_.world.bodies().end_step({});
  run_.forget_history();
  run_.ledger.rest();
  run_.finish_step();
  run_.actuation.advance_drives(run_.world.problem().actuators);
  return report_;
}

void StaticSolver::search() {
  read_goal();
  if (run::limits_motors(*run_.model, goal_) && find_without_limits()) return;
  find();
}

// See lift_motor_limits().
bool StaticSolver::find_without_limits() {
  std::vector<law::ActuatorBlock>& blocks = run_.world.problem().actuators;
  const std::vector<law::ActuatorBlock> limited = goal_;
  run::lift_motor_limits(*run_.model, goal_);
  blocks = goal_;
  bool found = true;
  try {
    find();
  } catch (const Error& failure) {
    if (!failure.is_run_failure()) throw;
    found = false;
  }
  blocks = goal_ = limited;
  if (found && run::keeps_motor_limits(*run_.model, goal_, run_.effort)) return true;
  run_.restore(run_.before);
  return false;
}

void StaticSolver::find() {
  if (!search_.equilibrate(0.0, max_idle(*run_.model))) approach();
  settling_.follow_surfaces();
  settling_.settle();
  if (run_.model->is_loose() || has_idle_motor()) settling_.require_held();
}

// Whether a motor is told an effort: it may hold nothing, though it could.
bool StaticSolver::has_idle_motor() const {
  const auto& actuators = run_.model->actuators();
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    if (actuators[i].joint >= 0 && !run_.world.problem().actuators[i].holds_motion()) return true;
  }
  return false;
}

void StaticSolver::read_goal() {
  start_ = run_.actuation.states();
  run_.read_commands(run_.time(), kInfinity);
  run::hold_efforts(run_.world.problem().actuators, run_.effort);
  goal_ = run_.world.problem().actuators;
  run_.solver.begin_step();
}

// Interpolates commands between the actuators' values at the start (fraction 1) and the goal (0).
void StaticSolver::blend(double fraction) {
  run_.world.problem().actuators = goal_;
  run::blend(run_.world.problem().actuators, start_, 1.0 - fraction);
}

// Applies load steps, then follows the path by arc length, then applies overdamped motion.
void StaticSolver::approach() {
  HomotopyPath path(run_, start_, goal_, std::max(settings_.tolerance, kPathTolerance));
  const double smallest = 1.0 / settings_.max_load_steps;
  const bool follows = path.is_possible();
  double fraction = step_load(follows ? std::max(smallest, kSmallestBeforePath) : smallest);
  if (fraction == 0.0 || (follows && follow_path(path, fraction))) return;
  const std::string known = describe(fraction);
  blend(0.0);
  run_.world.homotopy().set_fraction(0.0);
  const world::JointConflict conflict = find_conflict();
  if (!limit_point_ && (motion_.relax_from_here() || settling_.leave_nearby())) return;
  if (!limit_point_ && !conflict.text.empty()) fail_joints(run_, conflict);
  if (!limit_point_) fail_if_free(search_, kNoEquilibrium);
  fail_to_find(known);
}

// Uses the last equilibrium of the path, as condensed by describe(), with the full commands.
world::JointConflict StaticSolver::find_conflict() const {
  if (run_.world.inertia().status == linalg::FactorStatus::singular) return {};
  return find_joint_conflict(run_.world, kJointTolerance * run_.model->size());
}

// @param fraction of the residual in the present equilibrium, overwritten by that in the last one.
// @return whether it found the one under the full load.
bool StaticSolver::follow_path(HomotopyPath& path, double& fraction) {
  const HomotopyPath::End end = path.follow(fraction);
  turned_ = end == HomotopyPath::End::turned;
  if (end != HomotopyPath::End::full_load) return false;
  run::State last;
  run_.keep(last);
  blend(0.0);
  if (search_.equilibrate(0.0)) return true;
  run_.restore(last);
  return false;
}

// @param smallest load step. @return the remaining fraction of the residual.
double StaticSolver::step_load(double smallest) {
  run_.watch.enter(run::SearchStage::parts);
  run_.restore(run_.before);
  search_.linearise();
  run_.world.homotopy().keep_residual(run_.effort);
  run::State sound = run_.before;  // of the last equilibrium
  report_.load_steps = 0;
  const auto solve = [&](double fraction) {
    blend(fraction);
    return search_.equilibrate(fraction, max_idle(*run_.model));
  };
  const auto keep = [&] {
    ++report_.load_steps;
    run_.keep(sound);
  };
  return run::take_load_steps({.min = smallest}, solve, keep, [&] { run_.restore(sound); });
}

// Describes the last equilibrium of the path, which is the world's present state.
std::string StaticSolver::describe(double fraction) {
  search_.begin();
  run_.world.homotopy().set_fraction(fraction);
  search_.linearise();
  if (run_.world.condense() == linalg::FactorStatus::singular) {
    return "the exact tangent of the last equilibrium on the way is singular";
  }
  std::string limit = describe_limit_point(run_, goal_);
  limit_point_ = !limit.empty();
  if (!limit.empty() || fraction == 1.0) return limit;
  const double percent = 100.0 * (1.0 - fraction);
  if (turned_) {
    return fmt::format("at {:.3g} % of it the load reaches a peak (limit point)", percent);
  }
  const int negative = world::Stability(run_.world, run_.effort).negative_pivots();
  if (negative == 0) {
    return fmt::format("the last equilibrium on the way, at {:.3g} % of the load, is stable",
                       percent);
  }
  return fmt::format(
      "on the way to {:.3g} % of the load {} eigenvalue{} of the exact tangent passed zero: the "
      "robot buckles there",
      percent, negative, negative == 1 ? "" : "s");
}

void StaticSolver::fail_to_find(const std::string& known) {
  if (limit_point_) {
    fail(run_, ErrorKind::not_converged, known, kLimitPointRemedy);
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

}  // namespace sinew::statics
