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
    stops_points_ = run_.world.contacts().stops_points(run_.effort, time_step);
    if (stops_points_ && run_.last_step > 0.0) solve_afresh(time_step, divisible);
  } catch (...) {  // failures have gone back already; what a watcher throws has not
    run_.go_back();
    throw;
  }
}

bool Substep::reaches_back() const {
  return run_.model->step().integrator == mechanics::Integrator::generalized_alpha &&
         !run_.model->contacts().empty();
}

// Generalized-alpha carries on from the acceleration of the step before. Where a point is stopped
// there is none, but an impulse, and the point would rebound with twice the energy. Such a step is
// made again by backward Euler, v = d/h, and so is the next one, whose acceleration is the first to
// go on from.
void Substep::solve_afresh(double time_step, bool divisible) {
  run_.go_back();
  run_.last_step = 0.0;
  // Where the first solution held a controller's choice, its actuators were taken from it.
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
  run_.report.contact_sweeps = contacts.sweeps;
}

double Substep::end(double time_step) {
  const double error = run_.world.bodies().end_step(run_.step_weights(time_step));
  // A gap that closes stops its point at once. A multistep formula that reaches back over such a
  // jump would have the point rebound, and gain energy: it starts afresh behind it.
  const bool stops = stops_points_ || run_.world.contacts().gap_closed(run_.effort);
  run_.last_step = stops ? 0.0 : time_step;
  count();
  return error;
}

void Substep::end_as_midpoint(double time_step) {
  run_.world.bodies().end_step(mechanics::midpoint_weights(time_step));
  run_.last_step = time_step;
  count();
}

void Substep::count() {
  run_.finish_step();
  run_.actuation.advance_drives(run_.world.problem().actuators);
  run_.ledger.count(*run_.model, run_.world, run_.actuation, run_.effort);
}

}  // namespace sinew::sim
