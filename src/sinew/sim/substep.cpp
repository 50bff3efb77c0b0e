#include "sinew/sim/substep.hpp"

#include "sinew/core/error.hpp"
#include "sinew/sim/linear_step.hpp"
#include "sinew/sim/newton_step.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/step_failure.hpp"
#include "sinew/step/controller.hpp"

namespace sinew::sim {

void Substep::read_commands(double end, double time_step) {
  run_.now = end;
  run_.read_commands(end, time_step);
}

void Substep::begin(double time_step) {
  run_.keep(run_.before);
  held_before_ = run_.report.choice_held;
  begin_world(time_step);
}

void Substep::begin_world(double time_step) {
  run_.begin_world(time_step);
  run_.solver.begin_step();
  if (run_.controller != nullptr) run_.controller->begin_step();
}

void Substep::solve(double time_step, bool divisible) {
  try {
    solve_equation(time_step, divisible);
    if (!reaches_back()) return;
    stops_points_ = stops_points(time_step);
    if (stops_points_ && run_.last_step > 0.0) solve_afresh(time_step, divisible);
  } catch (...) {  // failures have restored the state already; exceptions of a watcher have not
    run_.go_back();
    throw;
  }
}

bool Substep::reaches_back() const {
  const auto integrator = run_.model->step().integrator;
  return !run_.model->contacts().empty() &&
         (integrator == mechanics::Integrator::generalized_alpha ||
          integrator == mechanics::Integrator::bdf2);
}

bool Substep::stops_points(double time_step) const {
  const bool alpha = run_.model->step().integrator == mechanics::Integrator::generalized_alpha;
  return run_.world.turns_back(time_step) ||
         (alpha && run_.world.contacts().stops_points(run_.effort, time_step));
}

// Generalized-alpha uses the acceleration of the previous step. At a point that is stopped, this is
// an impulse instead, and the point would rebound with twice the energy. Such a step is repeated
// with backward Euler, v = d/h, and so is the next one, whose acceleration is the first that can be
// used. A step of any multistep formula is also repeated if a point with kinetic friction comes to
// rest: its velocity would reverse before static friction can hold it.
void Substep::solve_afresh(double time_step, bool divisible) {
  run_.go_back();
  run_.last_step = 0.0;
  // The discarded solution set this flag if it held the controller's choice.
  run_.report.choice_held = held_before_;
  run_.read_commands(run_.now, time_step);
  begin_world(time_step);
  solve_equation(time_step, divisible);
}

void Substep::solve_equation(double time_step, bool divisible) {
  if (run_.model->step().method == Method::newton) {
    NewtonStep(run_, divisible).solve(time_step);
  } else {
    LinearStep(run_).solve(time_step);
  }
  if (run_.model->contacts().empty()) return;
  if (run_.world.contacts().passed()) {
    fail(run_, ErrorKind::not_converged, "surfaces would pass through each other",
         "take a smaller time step");
  }
  const qp::ConeResult& contacts = run_.solver.direct().contact_result();
  run_.report.contact_residual = contacts.residual;
  run_.report.contact_signorini = contacts.signorini;
  run_.report.contact_coulomb = contacts.coulomb;
  run_.report.contact_complementarity = contacts.complementarity;
  run_.report.contact_sweeps = contacts.sweeps;
}

double Substep::end(double time_step) {
  const double error = run_.world.bodies().end_step(run_.step_weights(time_step));
  // A closing gap stops its point at once. A multistep formula across such a jump would let the
  // point rebound and gain energy; it therefore restarts after the jump. So it does when friction
  // falls from its static to its kinetic limit.
  const ContactRows& contacts = run_.world.contacts();
  const bool jumps =
      stops_points_ || contacts.gap_closed(run_.effort) || contacts.breaks_loose(run_.effort);
  run_.last_step = jumps ? 0.0 : time_step;
  count();
  return error;
}

void Substep::end_as_midpoint(double time_step) {
  run_.world.bodies().end_step(mechanics::midpoint_weights(time_step));
  run_.last_step = time_step;
  count();
}

void Substep::count() {
  run_.report.contact_aggregation =
      run_.world.contacts().end_zones(run_.world.problem(), run_.world.numbering(), run_.effort);
  run_.finish_step();
  run_.actuation.advance_drives(run_.world.problem().actuators);
  run_.ledger.count(*run_.model, run_.world, run_.actuation, run_.effort);
}

}  // namespace sinew::sim
