#include "sinew/step/linear_step.hpp"

#include <limits>

#include <fmt/format.h>

#include "sinew/run/run.hpp"
#include "sinew/run/step_tolerances.hpp"
#include "sinew/statics/rest_search.hpp"
#include "sinew/statics/step_failure.hpp"
#include "sinew/step/step_verdict.hpp"
#include "sinew/world/sanity.hpp"

namespace sinew::step {

namespace {

constexpr int kMaxStepHalvings = 10;
// Penetration, relative to the robot's size, beyond rounding for a point without a force.
constexpr double kMaxDepth = 1e-6;

}  // namespace

void LinearStep::solve(double time_step) {
  if (run_.model->step().dynamic()) run_.world.bodies().drift(time_step);
  mechanics::LinearisationRequest request = run_.request(time_step);
  request.iterating = false;
  linearise(request);
  condense(request);
  run::StepReport& report = run_.report;
  report.law = run_.world.solve_step(run_.solver, run_.controller, run_.effort, run_.clock);
  if (report.law == run::LawStatus::failed) statics::fail_law(run_);
  report.iterations = 1;
  move_soundly();
  run_.clock.mark(world::Stage::correction);
  require_outside();
  look_back(request);
}

void LinearStep::linearise(const mechanics::LinearisationRequest& request) {
  run_.world.linearise(request);
  run_.clock.mark(world::Stage::assembly);
  run_.world.form_rows(run_.effort, run_.model->geometric_stiffness().in_steps);
  run_.clock.mark(world::Stage::rows);
}

// Uses the projected tangent if the exact one is indefinite. A factorisation for definite matrices
// only then reports a singular matrix.
void LinearStep::condense(mechanics::LinearisationRequest& request) {
  auto status = run_.world.condense();
  const bool suits = status != linalg::FactorStatus::singular && run_.world.is_stable();
  if (!suits && request.tangent == mechanics::Tangent::exact) {
    request.tangent = mechanics::Tangent::projected;
    linearise(request);
    status = run_.world.condense();
  }
  run_.clock.mark(world::Stage::factorisation);
  if (status == linalg::FactorStatus::singular) {
    if (!run_.model->step().dynamic()) {
      statics::fail_if_free(run_, run::NewtonStatus::singular, run_.model->step().time_step);
    }
    statics::fail(run_, ErrorKind::singular_matrix, "the stiffness matrix is singular",
                  "fix a region of every body, or look for loose or crushed elements");
  }
}

// Applies the motion, or the largest halving of it that inverts no element.
void LinearStep::move_soundly() {
  const bool was_sound = run_.volume_ratio > 0.0;
  run::StepReport& report = run_.report;
  report.scale = 1.0;
  mechanics::MotionReport motion;
  for (int halving = 0; halving <= kMaxStepHalvings; ++halving, report.scale *= 0.5) {
    motion = run_.world.bodies().apply_motion(report.scale);
    if (motion.finite) motion.volume = run_.world.bodies().smallest_volume();
    if (motion.finite && (motion.volume.ratio > 0.0 || !was_sound)) {
      run_.volume_ratio = report.smallest_volume_ratio = motion.volume.ratio;
      moved_ = motion.largest_move;
      return;
    }
  }
  if (!motion.finite) {
    statics::fail(run_, ErrorKind::diverged,
                  "the motion of this step is not finite or out of all proportion",
                  "take a smaller time step, or check loads and material");
  }
  statics::fail(
      run_, ErrorKind::inverted_in_run,
      fmt::format("element {} would turn inside out (det F = {:.3g}) even at {:.2g} of the motion",
                  motion.volume.element, motion.volume.ratio, 2.0 * report.scale),
      "take a smaller time step, change commands more slowly, or refine the mesh there");
}

// Points in bodies whose motion is prescribed cannot be moved by any contact force.
void LinearStep::require_outside() {
  if (run_.model->contacts().empty()) return;
  const double depth = run_.world.contacts().max_penetration_without_force(run_.effort);
  if (depth <= kMaxDepth * run_.model->size()) return;
  statics::fail(
      run_, ErrorKind::not_converged,
      fmt::format("a point would be {:.3g} m inside a surface, and no contact force can move it",
                  depth),
      "take a smaller time step, or command no motion that ends in the surface");
}

void LinearStep::look_back(mechanics::LinearisationRequest request) {
  request.tangent = run_.model->step().tangent;
  request.iterating = true;
  linearise(request);
  run::StepReport& report = run_.report;
  report.residual = run_.world.bodies().residual(run_.effort);
  report.relative_residual = report.residual / (run_.world.bodies().force_scale() + 1e-300);
  report.violation = run_.world.violation(run_.effort, report.law);
  report.following = false;
  report.distance = std::numeric_limits<double>::infinity();
  if (report.scale == 1.0) {
    run_.correction_solver.begin_step();
    const double left = run_.world.correction(run_.correction_solver, run_.effort);
    report.distance =
        run::distance_bound(left, moved_, report.relative_residual, run_.world.problem().size);
  }
  require_solution();
}

void LinearStep::require_solution() {
  run::StepReport& report = run_.report;
  const world::Sanity sanity = world::examine(run_.world, run_.effort);
  report.physical = sanity.sound();
  run_.volume_ratio = report.smallest_volume_ratio = sanity.volume.ratio;
  if (run_.keeps_going || is_balanced(run_)) return;
  if (!report.physical) {
    statics::fail(
        run_, ErrorKind::diverged,
        "the step ends in a state that is not physical: " + world::describe(sanity, *run_.model),
        "use `solver: newton`, or take a smaller time step");
  }
  statics::fail(run_, ErrorKind::not_converged,
                fmt::format("one linearisation leaves {:.2g} % of the forces out of balance",
                            100.0 * report.relative_residual),
                step_status_remedy(run::StepStatus::not_in_equilibrium, run_.model->step()));
}

}  // namespace sinew::step
