#include "sinew/step/substep.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sinew/core/error.hpp"
#include "sinew/law/controller.hpp"
#include "sinew/run/run.hpp"
#include "sinew/statics/step_failure.hpp"
#include "sinew/step/linear_step.hpp"
#include "sinew/step/newton_step.hpp"
#include "sinew/step/step_verdict.hpp"
#include "sinew/step/without_controller.hpp"
#include "sinew/world/connected_bodies.hpp"
#include "sinew/world/end_efforts.hpp"
#include "sinew/world/row_motions.hpp"

namespace sinew::step {

namespace {

// Smaller gains of energy, relative to the energy, are rounding.
constexpr double kRounding = 1e-12;
// A controller chooses at most this often again after its choice has failed.
constexpr int kMaxFailures = 5;
// A held motion is slowed, not merely accelerated, if it loses more than this part of its velocity.
constexpr double kSlows = 0.1;

// Whether an actuator or a limit of a joint may stop a motion that it did not hold before.
bool may_catch(const law::ActuatorBlock& block) {
  if (block.row < 0 || block.owned || block.drive != nullptr) return false;
  if (block.kind == law::CommandKind::motion) {
    return std::isfinite(block.effort_min) || std::isfinite(block.effort_max);
  }
  return std::isfinite(block.motion_min) || std::isfinite(block.motion_max);
}

// Whether it does not hold its motion: a slack cable, a stalled motor, a limit that is not reached.
bool is_idle(const law::ActuatorBlock& block, double effort) {
  if (block.kind != law::CommandKind::motion) return effort == block.value;
  return effort <= block.effort_min || effort >= block.effort_max;
}

// Whether a smaller motion may not fail.
bool is_too_far(const Error& failure) {
  return failure.kind() == ErrorKind::not_converged ||
         failure.kind() == ErrorKind::inverted_in_run || failure.kind() == ErrorKind::diverged;
}

}  // namespace

Substep::Substep(run::Run& run) : run_(run), marks_(run.world.bodies().all().size(), 0) {}

void Substep::read_commands(double end, double time_step) {
  run_.now = end;
  run_.read_commands(end, time_step);
}

void Substep::begin(double time_step) {
  run_.keep(run_.before);
  held_before_ = run_.report.choice_held;
  failures_ = 0;
  holds_back_ = false;
  std::ranges::fill(marks_, 0);
  if (may_start_afresh() || run_.controller != nullptr) actuators_ = run_.world.problem().actuators;
  begin_world(time_step);
  if (lands_by_bdf2_) energy_before_ = run_.world.bodies().energies().total();
}

void Substep::begin_world(double time_step) {
  lands_by_bdf2_ = run_.model->step().integrator == mechanics::Integrator::bdf2 &&
                   !run_.model->contacts().empty() && run_.last_step > 0.0;
  run_.begin_world(time_step);
  run_.solver.begin_step();
  if (run_.controller != nullptr) run_.controller->begin_step(failures_);
}

// A controller may choose efforts that the robot cannot follow within a step, as where it buckles.
// Like any step outside the region in which its linearisation can be trusted (J. Nocedal & S. J.
// Wright, Numerical Optimization (2006), algorithm 4.1), the step is rejected, and the controller
// chooses a smaller change of efforts.
void Substep::solve(double time_step, bool divisible) {
  divisible_ = divisible;
  while (true) {
    try {
      return solve_once(time_step);
    } catch (const Error& failure) {
      run_.go_back();
      if (divisible || run_.controller == nullptr || !is_too_far(failure)) throw;
      if (failures_ == kMaxFailures) return hold_back(time_step, failure);
    } catch (...) {  // of a watcher
      run_.go_back();
      throw;
    }
    ++failures_;
    ++run_.report.retries;
    begin_again(time_step);
  }
}

// No change of efforts that the controller chose can be followed: its actuators keep the efforts of
// the last step. @param failure of its last choice.
void Substep::hold_back(double time_step, const Error& failure) {
  run_.watch.enter(run::SearchStage::last_efforts);
  const std::vector<model::ActuatorState>& states = run_.actuation.states();
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].chosen) actuators_[i].hold_effort(states[i].effort);
  }
  begin_again(time_step);
  try {
    const WithoutController without(run_);
    solve_once(time_step);
  } catch (const Error& other) {
    run_.go_back();
    if (!other.is_run_failure()) throw;
    throw Error(failure.kind(), failure.place(),
                failure.message() + "; the efforts of the last step do not solve it either",
                failure.remedy());
  } catch (...) {  // of a watcher
    run_.go_back();
    throw;
  }
  holds_back_ = true;
  run_.report.choice_held = true;
  run_.controller->hold_back(failures_ + 1);
}

void Substep::solve_once(double time_step) {
  solve_equation(time_step, divisible_);
  if (!may_start_afresh()) return;
  mark_stopped(time_step);
  if (run_.last_step > 0.0 && marks_others()) solve_afresh(time_step);
}

bool Substep::may_start_afresh() const {
  if (mechanics::history_count(run_.model->step().integrator) == 0) return false;
  return !run_.model->contacts().empty() ||
         std::ranges::any_of(run_.world.problem().actuators, &may_catch);
}

void Substep::mark_stopped(double time_step) {
  const bool alpha = run_.model->step().integrator == mechanics::Integrator::generalized_alpha;
  run_.world.mark_turning_back(time_step, marks_);
  if (alpha) run_.world.contacts().mark_stopped(run_.effort, marks_);
  mark_caught(time_step);
  spread_marks();
}

// Marks bodies that a cable that becomes taut, or a limit of a joint, stops in this part. Friction
// of joints, a commanded motion after the actuators, brings them to rest without a jump.
void Substep::mark_caught(double time_step) {
  const std::vector<law::ActuatorBlock>& blocks = run_.world.problem().actuators;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const law::ActuatorBlock& block = blocks[i];
    const bool brakes =
        i >= run_.model->actuators().size() && block.kind == law::CommandKind::motion;
    if (brakes || !may_catch(block)) continue;
    const int row = run_.world.numbering().model_row_of(block.row);
    const auto k = static_cast<std::size_t>(row);
    if (is_idle(block, run_.effort[k])) continue;
    // What starts from rest stops nothing.
    const bool moves = run_.last_step > 0.0 || world::row_velocity(run_.world, row) != 0.0;
    const bool catches = moves && is_idle(block, run_.before.efforts[k]);
    if (catches || still_stops(i, row, time_step)) mark_row(row);
  }
}

// A stop takes two steps: in the first one, the motion ends at the limit, and its velocity d/h is
// what is left of the way; the second one takes that away. Whether the present step is of backward
// Euler, and slows a motion that is held.
bool Substep::still_stops(std::size_t block, int row, double time_step) const {
  if (run_.last_step > 0.0 && !run_.world.bodies().any_afresh()) return false;
  const bool commanded = block < run_.model->actuators().size();
  const double way = commanded ? run_.world.delta()[row] - run_.before.motions[block] : 0.0;
  const double before = world::row_velocity(run_.world, row), now = way / time_step;
  return std::abs(before - now) > kSlows * std::abs(before) && std::abs(now) < std::abs(before);
}

void Substep::mark_row(int row) {
  const mechanics::RowPattern& pattern = run_.model->rows();
  const auto k = static_cast<std::size_t>(row);
  for (std::int32_t e = pattern.row_start[k]; e < pattern.row_start[k + 1]; ++e) {
    const std::int32_t body = pattern.site[static_cast<std::size_t>(e)].body;
    if (body >= 0) marks_[static_cast<std::size_t>(body)] = 1;
  }
}

// Whether a body is marked whose formula reaches back in this part.
bool Substep::marks_others() const {
  const std::vector<char>& afresh = run_.world.bodies().afresh();
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    if (marks_[i] != 0 && afresh[i] == 0) return true;
  }
  return false;
}

// An impulse at a body reaches all bodies that are connected to it by rows with an effort.
void Substep::spread_marks() {
  if (std::ranges::find(marks_, 1) == marks_.end()) return;
  world::mark_connected_bodies(*run_.model, run_.world.bodies().systems(), run_.effort, marks_);
}

// Generalized-alpha uses the acceleration of the previous step. At a point that is stopped, this is
// an impulse instead, and the point would rebound with twice the energy. Such a step is repeated
// with backward Euler, v = d/h, for the bodies that the impulse reaches, and so is the next one,
// whose acceleration is the first that can be used. The same holds for any multistep formula where
// a cable becomes taut or a joint reaches its limit: in BDF2, v = (3 d - d_before)/(2 h) is a
// rebound. A step of any multistep formula is also repeated if a point with kinetic friction comes
// to rest: its velocity would reverse before static friction can hold it.
void Substep::solve_afresh(double time_step) {
  run_.go_back();
  std::vector<char>& afresh = run_.world.bodies().afresh();
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    if (marks_[i] != 0) afresh[i] = 1;
  }
  begin_again(time_step);
  solve_equation(time_step, divisible_);
}

// The actuators get the blocks of the start again, since the commands of a part of a step are
// interpolated (Stepper), and a controller's choice that did not settle has replaced its blocks.
void Substep::begin_again(double time_step) {
  run_.report.choice_held = held_before_;
  run_.world.problem().actuators = actuators_;
  begin_world(time_step);
}

void Substep::solve_equation(double time_step, bool divisible) {
  if (run_.model->step().method == model::Method::newton) {
    NewtonStep(run_, divisible).solve(time_step);
  } else {
    LinearStep(run_).solve(time_step);
  }
  const bool statics = !run_.model->step().dynamic();
  if (statics && !run_.keeps_going && is_balanced(run_) && !reactions_balance(run_)) {
    statics::fail(
        run_, ErrorKind::not_converged,
        "the reactions of what is fixed do not balance the loads, although no residual is left",
        "look for parts of the robot that nothing holds");
  }
  if (run_.model->contacts().empty()) return;
  run_.clock.mark(world::Stage::correction);
  const bool passed = run_.world.contacts().passed();
  run_.clock.mark(world::Stage::detection);
  if (passed) {
    statics::fail(run_, ErrorKind::not_converged, "surfaces would pass through each other",
                  "take a smaller time step");
  }
  const qp::ConeResult& contacts = run_.solver.direct().contact_result();
  run_.report.contact_residual = contacts.residual;
  run_.report.contact_signorini = contacts.signorini;
  run_.report.contact_coulomb = contacts.coulomb;
  run_.report.contact_complementarity = contacts.complementarity;
  run_.report.contact_sweeps = contacts.sweeps;
}

// In BDF2, v = (3 d - d_before)/(2 h). A point that lands gets a velocity down to -d_before/(2 h),
// depending on the gap that was left: it rebounds with up to half its speed. Several such points
// can gain energy, as points with different coefficients of restitution do (Kane's paradox).
// Backward Euler gains none: with M (v - v_before) = h (p + H^T lambda) and v = d/h, the energy
// changes by
//   lambda.H d - |v - v_before|^2_M/2 <= 0,   lambda.H d = -lambda_n.gap + lambda_t.slip <= 0,
// with the gap at the start of the step, for a convex potential and rows that do not turn. A
// landing that gains energy is therefore repeated with backward Euler, and so is a step in which
// friction stops a point, which gets such a velocity along the surface. Others are kept, since
// rolling bodies land in every step.
double Substep::end(double time_step) {
  double error = end_once(time_step);
  if (lands_by_bdf2_ && lands() && has_gained()) {
    std::ranges::fill(marks_, 1);
    repeat_afresh(time_step);
    error = end_once(time_step);
  }
  end_zones();
  return error;
}

// Repeats the step with backward Euler. Where all choices of the controller were rejected, it makes
// none again.
void Substep::repeat_afresh(double time_step) {
  try {
    std::optional<WithoutController> without;
    if (holds_back_) without.emplace(run_);
    solve_afresh(time_step);
  } catch (...) {
    run_.go_back();
    throw;
  }
}

double Substep::end_once(double time_step) {
  const run::Quadrature quadrature = run_.quadrature();
  find_end_efforts(time_step);
  const double error =
      run_.world.bodies().end_step(run_.step_weights(time_step), run_.weights_afresh(time_step));
  run_.last_step = time_step;
  if (may_start_afresh()) start_afresh();
  count(quadrature, time_step);
  return error;
}

// Of the formulas that Substep ends, only backward Euler has other efforts at the end of a step.
// The step in which a multistep formula starts is one, too, but has no other before it.
void Substep::find_end_efforts(double time_step) {
  const mechanics::Integrator integrator = run_.model->step().integrator;
  const bool euler = integrator == mechanics::Integrator::backward_euler ||
                     integrator == mechanics::Integrator::event_driven;
  if (!euler) return run_.world.end_efforts().clear();
  run_.world.end_efforts().follow_backward_euler(run_.world, run_.effort,
                                                 run_.step_weights(time_step), run_.last_step);
}

// After a jump of its velocity or friction, a multistep formula restarts: a formula that reaches
// back over the jump would let the point rebound and gain energy. Friction jumps when it falls from
// its static to its kinetic limit.
void Substep::start_afresh() {
  run_.world.contacts().mark_impacts(run_.effort, marks_);
  run_.world.contacts().mark_loose(run_.effort, marks_);
  spread_marks();
  std::ranges::copy(marks_, run_.world.bodies().afresh().begin());
  const auto systems = run_.world.bodies().systems();
  bool all = true;
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    all = all && (marks_[i] != 0 || systems[i]->size() == 0);
  }
  if (all) run_.forget_history();
}

// Whether a point is stopped. One that lands is stopped in this step or, since the gap is closed at
// the end of the step only, in the next one.
bool Substep::lands() const {
  const contact::ContactRows& contacts = run_.world.contacts();
  return contacts.gap_closed(run_.effort) || contacts.stops_touching_point(run_.effort) ||
         contacts.catches(run_.effort);
}

// Whether the energy of the bodies has grown by more than the work of actuators, loads and moving
// surfaces. Work of a moving base is not counted, so such a step may have gained energy.
bool Substep::has_gained() const {
  world::Bodies& bodies = run_.world.bodies();
  if (std::ranges::any_of(bodies.ends(), &mechanics::StepEnd::moved_from_outside)) return true;
  const run::EnergyLedger &before = run_.before.ledger, &now = run_.ledger.sums();
  const double work = now.actuators - before.actuators + now.outside - before.outside;
  const mechanics::Energies energies = bodies.energies();
  const double size = energies.kinetic + energies.strain + std::abs(energies.gravity);
  return energies.total() - energy_before_ - work > kRounding * size;
}

void Substep::end_as_midpoint(double time_step) {
  run_.world.bodies().end_step(mechanics::midpoint_weights(time_step));
  run_.last_step = time_step;
  count(run::Quadrature::one_force, time_step);
  end_zones();
}

// Adds up the friction history of zones, so it must not be called for a solution that is repeated.
void Substep::end_zones() {
  run_.report.contact_aggregation =
      run_.world.contacts().end_zones(run_.world.problem(), run_.world.numbering(), run_.effort);
}

void Substep::count(run::Quadrature quadrature, double time_step) {
  run_.finish_step();
  run_.actuation.advance_drives(run_.world.problem().actuators);
  run_.ledger.count(*run_.model, run_.world, run_.actuation,
                    {.effort_before = run_.before.efforts,
                     .effort = run_.effort,
                     .quadrature = quadrature,
                     .length = time_step,
                     .dynamic = run_.model->step().dynamic()});
  const bool stops = run_.last_step == 0.0 || run_.world.bodies().any_afresh();
  if (lands_by_bdf2_ && stops) limit_dissipation();
}

// In a BDF2 step that stops a point, the force at its end times the motion in it can be more than
// the energy that the impact dissipates, which is known: what the bodies lost and was put in.
void Substep::limit_dissipation() {
  const run::EnergyLedger &before = run_.before.ledger, &now = run_.ledger.sums();
  const double dissipated = now.dissipated - before.dissipated;
  const double put_in = now.put_in() - before.put_in();
  const double gain = run_.world.bodies().energies().total() - energy_before_ - put_in;
  run_.ledger.count_less_dissipation(std::clamp(gain, 0.0, std::max(dissipated, 0.0)));
}

}  // namespace sinew::step
