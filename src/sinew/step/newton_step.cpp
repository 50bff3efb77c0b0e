#include "sinew/step/newton_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "sinew/law/controller.hpp"
#include "sinew/run/load_steps.hpp"
#include "sinew/run/run.hpp"
#include "sinew/run/step_tolerances.hpp"
#include "sinew/statics/limit_point.hpp"
#include "sinew/statics/rest_search.hpp"
#include "sinew/statics/static_search.hpp"
#include "sinew/statics/step_failure.hpp"
#include "sinew/step/step_verdict.hpp"
#include "sinew/world/folded_cable.hpp"
#include "sinew/world/stability.hpp"

namespace sinew::step {

namespace {

// Bounds of a search, beyond which none of the steps of 600 random robots was solved
// (docs/solver.md).
// Iterations with the projected tangent, which descend to a stable equilibrium if there is one.
constexpr int kMaxDescents = 60;
// The same before a step is given up that has nearly reached an equilibrium.
constexpr int kMaxLongDescents = 300;
// Smallest part of a quasi-static step, and smallest first part.
constexpr double kMinPart = 1.0 / 64.0;
constexpr double kMinFirstPart = 1.0 / 16.0;
constexpr int kIterationsOfPart = 25;
constexpr int kIterationsInParts = 1000;
// The search ends after this many first iterations with an indefinite exact tangent.
constexpr int kIndefinite = 25;
// A controller makes a new choice in every iteration, which need not settle: after this many, its
// efforts are held. It must also run in real time: its quasi-static steps are not divided, and take
// at most as many iterations with held efforts, with either tangent.
constexpr int kSteeredIterations = 8;
// Maximum iterations of a dynamic step that can be halved: steps of 40 ms of a crawling robot
// converge within 15 iterations or not within 50 (docs/performance.md).
constexpr int kIterationsBeforeHalving = 16;
// Joints are in conflict if the last iteration moved less than the first fraction of their gap, and
// if the contradiction, which the joints involved share, is at least the second fraction of it.
constexpr double kAtRest = 0.1;
constexpr double kShare = 0.01;
// A step that passes unstable states and moves this many times as far as its first iteration has
// left its branch.
constexpr double kSnap = 5.0;
// The same without having seen an unstable state: iterations may leap over them.
constexpr double kLeap = 20.0;
// Smaller motions, relative to the robot's size, reach no other branch.
constexpr double kSeen = 1e-3;

bool converged(const run::NewtonReport& result) {
  return result.status == run::NewtonStatus::converged;
}

// Whether the matrix is singular at the start of the step. Else it is singular only at the states
// of iterations beyond the last equilibrium, where nothing is loose.
bool starts_singular(run::Run& run, double time_step) {
  const std::vector<law::ActuatorBlock> goal = run.world.problem().actuators;
  run.restore(run.before);
  run.begin_world(time_step);
  run.world.linearise({{}, mechanics::Tangent::exact, true, true});
  run.world.form_rows(run.effort, run.model->geometric_stiffness().all);
  const bool singular = run.world.condense() == linalg::FactorStatus::singular;
  run.world.problem().actuators = goal;
  return singular;
}

bool goes_on(const run::NewtonReport& result) {
  return !converged(result) && result.law != run::LawStatus::failed;
}

}  // namespace

bool NewtonStep::follows() const {
  return run_.equilibrium() == model::Equilibrium::following && !run_.model->errors_last() &&
         !run_.model->step().tolerance;
}

run::NewtonSettings NewtonStep::settings(double time_step) const {
  const model::StepSettings& step = run_.model->step();
  const bool lasts = run_.model->errors_last();
  const double usual = lasts       ? model::kLastingTolerance
                       : follows() ? model::kFollowingTolerance
                                   : model::kQuasiStaticTolerance;
  const int most = divisible_ && step.dynamic() ? kIterationsBeforeHalving : step.max_iterations;
  run::NewtonSettings result;
  result.request = run_.request(time_step);
  result.tolerance = step.tolerance.value_or(usual);
  result.motion_tolerance = std::min(result.tolerance, run::kMotionTolerance);
  result.max_iterations = std::min(most, step.max_iterations);
  result.geometric = run_.model->geometric_stiffness().in_steps;
  if (follows()) result.lag = run::kLag;
  if (lasts && !step.tolerance) result.stalled_tolerance = model::kStalledTolerance;
  result.strict = !step.tolerance;
  // Where contacts hold a body by more forces than it needs, those of the law depend on the way to
  // them, and a grip that is symmetric with new factors turns its body with kept ones.
  // In dynamics, efforts that hold a motion inherit its error times M/h^2: the last iterations of
  // Newton's method leave much less of it than the tolerance, those with an old factor just less.
  const bool unique = run_.model->contacts().empty();
  if (unique && (!step.dynamic() || !holds_motion())) result.kept_factors = &run_.kept_factors;
  return result;
}

bool NewtonStep::holds_motion() const {
  const law::StepProblem& problem = run_.world.problem();
  return !problem.bilaterals.empty() ||
         std::ranges::any_of(problem.actuators, &law::ActuatorBlock::holds_motion);
}

run::NewtonSettings NewtonStep::settings_of_part(double time_step) const {
  run::NewtonSettings part = settings(time_step);
  part.max_iterations = std::min(part.max_iterations, kIterationsOfPart);
  return part;
}

// A state that is no solution is kept only if the caller asks for it (Run::keeps_going).
void NewtonStep::solve(double time_step) {
  run::NewtonReport result = search(time_step);
  if (converged(result) && (must_settle() || (descended_ && is_unstable(time_step)))) {
    statics::RestSearch(run_, time_step).settle(settings(time_step), result);
  }
  take_report(result);
  if (converged(result)) return bound_distance(result);
  const world::JointConflict conflict = find_conflict(result, time_step);
  const bool usable = !conflict.opens && is_usable(result);
  if (usable && (run_.keeps_going || is_balanced(run_))) return;
  if (run_.keeps_going && stays_where_it_was(time_step)) return;
  if (!conflict.text.empty()) statics::fail_joints(run_, conflict);
  if (result.status == run::NewtonStatus::law_failed) statics::fail_law(run_);
  const std::string text = describe(result, settings(time_step));
  const std::string folded =
      world::describe_folded_cable(*run_.model, run_.world.configuration(), run_.effort);
  const bool dynamic = run_.model->step().dynamic();
  if (!dynamic && run_.model->is_loose()) statics::fail_if_free(run_, result.status, time_step);
  if (!folded.empty()) {
    statics::fail(run_, ErrorKind::not_converged, text + folded,
                  "lessen its tension, or place its points so that they stay apart");
  }
  if (!searches_on(result)) {
    if (!dynamic) statics::fail_if_free(run_, result.status, time_step);
    statics::fail(run_, kind_of(result), text + describe_choice(), remedy(result.status));
  }
  if (!approached_) {
    descended_ = false;
    const run::NewtonReport way = approach(time_step);
    if (converged(way)) return take_report(way);
  }
  if (!(reached_ > 0.0) && starts_singular(run_, time_step)) {
    statics::fail_if_free(run_, result.status, time_step);
  }
  fail_at_limit_point(result, time_step);
  const bool buckles = tried_fallbacks_ > 0;
  const std::string end = describe_end();
  if (buckles && falls(result, time_step)) return;
  statics::fail(
      run_, kind_of(result), text + end,
      buckles ? "command a motion (a volume_growth, a displacement) in place of an effort, use "
                "dynamics (`integrator: backward-euler`), or take smaller commands or loads"
              : remedy(result.status));
}

// Looks where the equilibria of a quasi-static step end.
void NewtonStep::fail_at_limit_point(const run::NewtonReport& result, double time_step) {
  const std::vector<law::ActuatorBlock> goal = run_.world.problem().actuators;
  run_.restore(sound_);
  run_.begin_world(time_step);
  run_.world.linearise({{}, mechanics::Tangent::exact, true, true});
  run_.world.form_rows(run_.effort, run_.model->geometric_stiffness().all);
  const bool singular = run_.world.condense() == linalg::FactorStatus::singular;
  const std::string limit = singular ? "" : statics::describe_limit_point(run_, goal);
  if (!limit.empty()) statics::fail(run_, kind_of(result), limit, statics::kLimitPointRemedy);
}

// Says where they end, at the last equilibrium on the way.
std::string NewtonStep::describe_end() const {
  std::string end = fmt::format(
      "; the last equilibrium on the way is at {:.3g} % of this step's "
      "changes{}",
      100.0 * reached_, describe_efforts(run_.world.problem().actuators));
  if (tried_fallbacks_ > 0) {
    end +=
        ", and beyond it the exact tangent is indefinite: the robot buckles, collapses or snaps "
        "there";
  }
  return end;
}

// Whether the present equilibrium is unstable, with what taut cables and contacts hold.
bool NewtonStep::is_unstable(double time_step) {
  if (run_.controller != nullptr) return false;  // which has no time to look
  const run::NewtonSettings own = settings(time_step);
  run::NewtonSettings whole = own;
  whole.request.with_geometric_stiffness = true;
  const auto condense = [&](const run::NewtonSettings& how, std::span<const int> geometric) {
    run_.world.linearise(how.request);
    run_.world.form_rows(run_.effort, geometric);
    return run_.world.condense();
  };
  const auto status = condense(whole, run_.model->geometric_stiffness().all);
  const bool unstable = status == linalg::FactorStatus::indefinite &&
                        !run_.world.inertia().unsymmetric && run_.world.inertia().is_counted() &&
                        world::Stability(run_.world, run_.effort).negative_pivots() > 0;
  if (!unstable) condense(own, own.geometric);  // which later queries read
  return unstable;
}

// Beyond a buckling load, the projected tangent approaches an unstable equilibrium, slowly; a
// symmetric robot does not pass it by itself.
// @return whether the robot comes to rest as it falls from the start of the step, and from the
// unstable equilibria that it meets; the step is then solved.
bool NewtonStep::falls(const run::NewtonReport& failed, double time_step) {
  run::NewtonReport rest = failed;
  if (failed.relative_residual <= run::kLag.residual) {
    run_.restore(run_.before);
    run_.begin_world(time_step);
    rest = descend(time_step, kMaxLongDescents);
    rest.iterations += failed.iterations;
  }
  if (!converged(rest)) rest = statics::RestSearch(run_, time_step).relax(rest);
  if (!converged(rest)) return false;
  statics::RestSearch(run_, time_step).settle(settings(time_step), rest);
  const int tried = rest.iterations;
  rest = run_.newton(nullptr, settings(time_step));  // by the step's own tolerance and tangent
  if (!converged(rest)) return false;
  rest.iterations += tried;
  part_snapped_ = true;
  take_report(rest);
  bound_distance(rest);
  return true;
}

// The commanded efforts that the last equilibrium has not reached: ", with 'air' at 11.9 of 12
// kPa".
std::string NewtonStep::describe_efforts(std::span<const law::ActuatorBlock> goal) const {
  std::string text;
  for (std::size_t i = 0; i < run_.model->actuators().size(); ++i) {
    const model::ActuatorModel& model = run_.model->actuators()[i];
    if (goal[i].kind != model::CommandKind::effort || goal[i].owned || goal[i].drive != nullptr)
      continue;
    const double reached = run_.effort[static_cast<std::size_t>(model.row)];
    if (reached == goal[i].value) continue;
    text += fmt::format("{}'{}' at {:.4g} of {:.4g} {}", text.empty() ? ", with " : ", ",
                        model.name, reached, goal[i].value, model.kind->effort.unit);
  }
  return text;
}

// What a controller chose in vain.
std::string NewtonStep::describe_choice() const {
  std::string text;
  for (std::size_t i = 0; i < run_.model->actuators().size(); ++i) {
    if (!run_.actuation.states()[i].chosen) continue;
    const model::ActuatorModel& model = run_.model->actuators()[i];
    text += fmt::format("{}{:.4g} {} for '{}'", text.empty() ? "; its controller chose " : ", ",
                        run_.effort[static_cast<std::size_t>(model.row)], model.kind->effort.unit,
                        model.name);
  }
  return text;
}

std::string NewtonStep::describe(const run::NewtonReport& result,
                                 const run::NewtonSettings& how) const {
  if (result.status == run::NewtonStatus::unphysical || !result.sanity.finite) {
    return "the step ends in a state that is not physical: " +
           world::describe(result.sanity, *run_.model);
  }
  std::string text = fmt::format(
      "Newton ended as '{}' after {} iterations, relative residual {:.3g} (tolerance {:.3g})",
      newton_status_name(result.status), result.iterations, result.relative_residual,
      how.tolerance);
  if (result.violation > how.motion_tolerance * run_.model->size()) {
    text += fmt::format(", commands and limits missed by {:.2g} m", result.violation);
  }
  const mechanics::SmallestVolume& volume = result.motion.volume;
  if (result.status == run::NewtonStatus::inverted && volume.element >= 0) {
    text += fmt::format(": it would turn element {} inside out", volume.element);
  }
  return text;
}

std::string NewtonStep::remedy(run::NewtonStatus status) const {
  const bool dynamic = run_.model->step().dynamic();
  std::string common = dynamic ? "take a smaller time step, or change commands more slowly"
                               : "change commands more slowly";
  if (status != run::NewtonStatus::inverted) return common;
  return common +
         "; if that does not help, the robot cannot bear the command or load: lessen it, "
         "or refine the mesh where it is crushed";
}

run::NewtonReport NewtonStep::search(double time_step) {
  run::NewtonSettings whole = settings(time_step);
  const bool steered = run_.controller != nullptr;
  if (!run_.model->step().dynamic()) whole.max_indefinite = kIndefinite;
  if (!run_.model->step().dynamic() && !steered) whole.max_idle = statics::max_idle(*run_.model);
  if (steered) {
    whole.max_choices = kSteeredIterations;
    if (run_.model->step().dynamic() || follows()) {
      whole.max_iterations = std::min(whole.max_iterations, kSteeredIterations);
    } else {
      whole.choice = run::kLag;
    }
  }
  if (!run_.model->step().dynamic() && !steered) {
    if (const auto held = hold_motors(time_step)) return *held;
  }
  run::NewtonReport result = run_.newton(run_.controller, whole);
  if (steered && goes_on(result)) return hold_choice(result, time_step);
  if (must_settle() && !converged(result))
    return statics::RestSearch(run_, time_step).relax(result);
  if (!searches_on(result)) return result;
  int tried = result.iterations;
  tried_fallbacks_ += result.tangent_fallbacks;
  if (result.iterations > 0 && result.tangent_fallbacks == result.iterations) {
    // A step that is unstable from its start is unstable in parts, too.
    run_.restore(run_.before);
    run_.begin_world(time_step);
  } else {
    result = approach(time_step);
    tried += result.iterations;
  }
  if (!converged(result)) {
    result = descend(time_step, kMaxDescents);
    tried += result.iterations;
  }
  result.iterations = tried;
  return result.status == run::NewtonStatus::singular
             ? statics::RestSearch(run_, time_step).relax(result)
             : result;
}

// Whether a failed iteration is followed by others. If all methods failed in the last step, they
// fail from there in this step, too.
bool NewtonStep::searches_on(const run::NewtonReport& result) const {
  if (run_.model->step().dynamic() || run_.controller != nullptr || converged(result)) return false;
  return !(run_.before.residual > run::kLag.residual);
}

// See lift_motor_limits(). None: it found no equilibrium within the limits.
std::optional<run::NewtonReport> NewtonStep::hold_motors(double time_step) {
  std::vector<law::ActuatorBlock>& blocks = run_.world.problem().actuators;
  if (!run::limits_motors(*run_.model, blocks)) return {};
  const std::vector<law::ActuatorBlock> limited = blocks;
  run::lift_motor_limits(*run_.model, blocks);
  const run::NewtonReport result = run_.newton(nullptr, settings(time_step));
  blocks = limited;
  if (converged(result) && run::keeps_motor_limits(*run_.model, blocks, run_.effort)) return result;
  run_.restore(run_.before);
  run_.begin_world(time_step);
  return {};
}

// A controller's choice need not settle: in the rest of the step, its last choice becomes the
// command of its actuators, within their limits.
run::NewtonReport NewtonStep::hold_choice(const run::NewtonReport& chosen, double time_step) {
  run_.watch.enter(run::SearchStage::held_efforts);
  run_.report.choice_held = true;
  const bool dynamic = run_.model->step().dynamic();
  run::NewtonSettings held = settings(time_step);
  const int few = std::min(held.max_iterations, kSteeredIterations);
  if (!dynamic) held.max_iterations = few;
  run::command_efforts(run_.world.problem().actuators, run_.effort);
  run::NewtonReport result = run_.newton(nullptr, held);
  int tried = chosen.iterations + result.iterations;
  if (!dynamic && goes_on(result)) {
    result = descend(time_step, few);
    tried += result.iterations;
  }
  if (!dynamic && goes_on(result) && !solves(result)) {
    result = stay(time_step);
    tried += result.iterations;
  }
  result.law = std::max(result.law, chosen.law);
  result.iterations = tried;
  return result;
}

// If a controller's choice leads to no solution, its actuators keep the efforts of the last step.
// The controller keeps the memory of its prediction, and trusts its next choice less (see
// control::StepDamping).
run::NewtonReport NewtonStep::stay(double time_step) {
  descended_ = part_snapped_ = false;
  run_.watch.enter(run::SearchStage::last_efforts);
  std::vector<double> memory(run_.controller->memory_size());
  run_.controller->save_memory(memory);
  run_.restore(run_.before);
  const std::vector<model::ActuatorState>& actuators = run_.actuation.states();
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    if (!actuators[i].chosen) continue;
    run_.world.problem().actuators[i].hold_effort(actuators[i].effort);
  }
  run_.begin_world(time_step);
  run::NewtonReport result = run_.newton(nullptr, settings(time_step));
  if (!converged(result)) result = approach(time_step);
  if (!converged(result)) result = descend(time_step, kMaxDescents);
  if (goes_on(result) && !solves(result)) result = remain(time_step, result);
  run_.controller->load_memory(memory);
  run_.controller->hold_back(0);
  return result;
}

// Whether a quasi-static step that fails, and whose end cannot be evaluated, may end at the last
// one.
bool NewtonStep::stays_where_it_was(double time_step) {
  if (run_.model->step().dynamic() || must_settle()) return false;
  const run::NewtonReport start = return_to_start(time_step);
  take_report(start);
  return is_usable(start);
}

// Returns to the end of the last step, for a robot that was about to buckle and from where Newton's
// method fails: it is as near to equilibrium as it was then.
run::NewtonReport NewtonStep::remain(double time_step, const run::NewtonReport& failed) {
  run::NewtonReport result = return_to_start(time_step);
  result.iterations = failed.iterations;
  return is_near(result) ? result : failed;
}

// Linearises at the end of the last step, with its efforts.
run::NewtonReport NewtonStep::return_to_start(double time_step) {
  run_.restore(run_.before);
  run_.begin_world(time_step);
  world::World& world = run_.world;
  const run::NewtonSettings how = settings(time_step);
  world.linearise(how.request);
  world.form_rows(run_.effort, how.geometric);
  run::NewtonReport result;
  result.status = run::NewtonStatus::stalled;
  result.residual = world.bodies().residual(run_.effort);
  result.relative_residual = result.residual / (world.bodies().force_scale() + 1e-300);
  result.violation = world.violation(run_.effort, result.law);
  result.motion.finite = true;
  result.sanity = examine(world, run_.effort);
  result.motion.volume = result.sanity.volume;
  return result;
}

// Whether the present state, which is linearised, is as near to an equilibrium with the present
// efforts as that of a following step: by the exact Newton correction.
bool NewtonStep::is_near(run::NewtonReport& result) {
  if (!(result.relative_residual <= run::kLag.residual)) return false;
  world::World& world = run_.world;
  if (world.condense() == linalg::FactorStatus::singular) return false;
  if (!world.is_stable() && !world.brace(run_.effort)) return false;
  const double left = correction();
  if (!(left <= run::kLag.move * world.problem().size)) return false;
  result.status = run::NewtonStatus::converged;
  result.distance = 2.0 * left;  // by the matrix of this state
  return true;
}

double NewtonStep::correction() {
  run_.correction_solver.begin_step();
  return run_.world.correction(run_.correction_solver, run_.effort);
}

// Contacts may change in every step, and with them the correction.
double NewtonStep::correction(const run::NewtonReport& result) {
  const double move = result.motion.largest_move;
  if (run_.model->contacts().empty()) {
    const auto known = run_.correction.estimate(result.residual, move);
    if (known && 2.0 * *known < move) return *known;
  }
  const double measured = correction();
  run_.correction.take(measured, result.residual, move);
  return measured;
}

// In dynamics, the moves of the iterations alone give a bound, since a solution of the law for it
// would cost more than it tells: the tolerance is narrow.
void NewtonStep::bound_distance(const run::NewtonReport& result) {
  run::StepReport& report = run_.report;
  report.following = follows();
  report.distance = result.distance;
  const bool stayed = result.motion.largest_move == 0.0;
  const bool known = std::isfinite(result.distance) && (stayed || !report.following);
  if (run_.model->step().dynamic() || known) return;
  report.distance = run::distance_bound(correction(result), result.motion.largest_move,
                                        result.relative_residual, run_.world.problem().size);
  // Moves with a turned factor tell of errors that the factor without its turns does not see.
  if (std::isfinite(result.distance)) report.distance = std::max(report.distance, result.distance);
}

// Removes the residual at the start of the step gradually, as in statics (static_solver.cpp), with
// commands interpolated from the actuators' values at the start.
run::NewtonReport NewtonStep::approach(double time_step) {
  run_.watch.enter(run::SearchStage::parts);
  world::World& world = run_.world;
  std::vector<law::ActuatorBlock>& commands = world.problem().actuators;
  const std::vector<law::ActuatorBlock> goal = commands;
  const std::vector<model::ActuatorState> start = run_.actuation.states();
  run::NewtonSettings part = settings_of_part(time_step);
  approached_ = true;
  part_snapped_ = false;
  sound_ = run_.before;
  const auto go_back = [&] {
    run_.restore(sound_);
    run_.begin_world(time_step);
  };
  run::NewtonSettings rough = part;  // of all parts but the last
  if (!run_.model->errors_last() && !run_.model->step().tolerance) {
    rough.tolerance = model::kFollowingTolerance;
    rough.lag = run::kLag;
  }
  go_back();
  world.linearise(part.request);
  world.form_rows(run_.effort, part.geometric);
  world.homotopy().keep_residual(run_.effort);
  run::NewtonReport result;
  int iterations = 0;
  const auto solve = [&](double fraction) {
    if (iterations == kIterationsInParts) return false;
    part.max_iterations = std::min(part.max_iterations, kIterationsInParts - iterations);
    rough.max_iterations = part.max_iterations;
    commands = goal;
    run::blend(commands, start, 1.0 - fraction);
    world.homotopy().set_fraction(fraction);
    result = run_.newton(nullptr, fraction > 0.0 ? rough : part);
    iterations += result.iterations;
    tried_fallbacks_ += result.tangent_fallbacks;
    part_snapped_ = part_snapped_ || snaps(result);
    return converged(result);
  };
  const double left = run::take_load_steps(
      {.first = 0.5, .min = kMinPart, .min_at_first = kMinFirstPart}, solve,
      [&] { run_.keep(sound_); }, go_back);
  reached_ = 1.0 - left;
  world.homotopy().set_fraction(0.0);
  commands = goal;
  result.iterations = iterations;
  return result;
}

// Continues from where approach() ended. With a matrix that majorises the derivative, every
// iteration lowers the energy of conservative loads, through buckling to an equilibrium. Newton's
// method completes the slow end of this descent.
run::NewtonReport NewtonStep::descend(double time_step, int iterations) {
  run_.watch.enter(run::SearchStage::downhill);
  descended_ = true;
  run::NewtonSettings downhill = settings(time_step);
  downhill.request.tangent = mechanics::Tangent::projected;
  // A majorant requires the stiffness of all cables, even of those that the scene leaves out.
  downhill.request.with_geometric_stiffness = true;
  downhill.geometric = run_.model->geometric_stiffness().all;
  downhill.max_iterations = iterations;
  run::NewtonReport result = run_.newton(nullptr, downhill);
  if (converged(result) || run_.controller != nullptr) return result;
  const int descended = result.iterations;
  result = run_.newton(nullptr, settings_of_part(time_step));
  result.iterations += descended;
  return result;
}

// A continuous step moves about as far as its first iteration, whose tangent is stable, predicts.
bool NewtonStep::snaps(const run::NewtonReport& result) const {
  if (run_.model->step().dynamic() || !converged(result)) return false;
  if (descended_ || part_snapped_) return true;
  const double most = result.tangent_fallbacks > 0 ? kSnap : kLeap;
  return result.whole_move > most * result.first_move &&
         result.whole_move > kSeen * run_.model->size();
}

ErrorKind NewtonStep::kind_of(const run::NewtonReport& result) {
  return result.status == run::NewtonStatus::unphysical ? ErrorKind::diverged
                                                        : ErrorKind::not_converged;
}

// Whether a result that is not converged is a solution nevertheless, see is_balanced().
bool NewtonStep::solves(const run::NewtonReport& result) {
  take_report(result);
  return is_usable(result) && is_balanced(run_);
}

// Whether weight, cables or contacts must hold what joints leave free: Newton's method may then
// find an equilibrium that is unstable, a standing pendulum, or one that a touch moves away.
bool NewtonStep::must_settle() const {
  return run_.model->is_loose() && !run_.model->step().dynamic() && run_.controller == nullptr;
}

// Whether a step may end in this state, with a flag. Contacts admit no approximate solution, since
// a point would be inside a surface; with contacts, the residual is limited as for the steps of a
// controller. In dynamics the impulse of a residual would remain, and only solutions count.
bool NewtonStep::is_usable(const run::NewtonReport& result) const {
  if (!result.motion.finite || !(result.motion.volume.ratio > 0.0)) return false;
  if (result.law == run::LawStatus::failed || !result.sanity.finite) return false;
  if (run_.model->step().dynamic())
    return result.status == run::NewtonStatus::unphysical && !divisible_;
  if (result.status == run::NewtonStatus::singular || must_settle()) return false;
  if (run_.model->contacts().empty()) return true;
  return result.relative_residual <=
             (run_.controller == nullptr ? model::kFollowingTolerance : run::kLag.residual) &&
         result.violation <= run::kMotionTolerance * run_.model->size();
}

// Looks for a conflict if iterations have come to rest although joints are open.
world::JointConflict NewtonStep::find_conflict(const run::NewtonReport& result,
                                               double time_step) const {
  const double open = result.violation, size = run_.model->size();
  const double tolerance = settings(time_step).motion_tolerance;
  const bool rests = result.motion.finite && result.motion.largest_move <= kAtRest * open;
  if (result.law == run::LawStatus::failed || !rests || !(open > tolerance * size)) return {};
  return find_joint_conflict(run_.world, kShare * open);
}

void NewtonStep::take_report(const run::NewtonReport& result) {
  run::StepReport& report = run_.report;
  report.law = result.law;
  report.residual = result.residual;
  report.relative_residual = result.relative_residual;
  report.violation = result.violation;
  report.distance = std::numeric_limits<double>::quiet_NaN();
  report.following = false;
  report.iterations = result.iterations;
  report.newton = result.status;
  report.scale = 1.0;
  report.snapped = snaps(result);
  report.physical = result.sanity.sound();
  run_.volume_ratio = report.smallest_volume_ratio = result.sanity.volume.ratio;
}

}  // namespace sinew::step
