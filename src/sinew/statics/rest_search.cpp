#include "sinew/statics/rest_search.hpp"

#include "sinew/run/run.hpp"
#include "sinew/statics/step_failure.hpp"

namespace sinew::statics {

namespace {

// Tolerance on residual and violation: that of solve_static() would cost more steps than the
// motion of the robot in a step is worth.
constexpr double kRestTolerance = 1e-8;

}  // namespace

RestSearch::RestSearch(run::Run& run, double time_step)
    : run_(run),
      time_step_(time_step),
      settings_{.tolerance = kRestTolerance},
      search_(run, settings_),
      motion_(search_) {
  search_.set_rest(run.step_weights(time_step));
}

run::NewtonReport RestSearch::relax(const run::NewtonReport& failed) {
  run_.restore(run_.before);
  run_.begin_world(time_step_);
  const bool found = motion_.relax_from_here();
  run::NewtonReport result = found ? search_.last() : failed;
  result.iterations = failed.iterations + search_.report().iterations;
  return result;
}

void RestSearch::settle(const run::NewtonSettings& settings, run::NewtonReport& result) {
  Settling settling(search_, motion_);
  settling.settle();
  settling.require_held();
  if (const int iterations = search_.report().iterations; iterations > 0) {
    const int before = result.iterations;
    result = search_.last();
    result.iterations = before + iterations;
  }
  // Later queries of this step read the tangent of the step.
  search_.begin();
  run_.world.linearise(settings.request);
  run_.world.form_rows(run_.effort, settings.geometric);
  run_.world.condense();
}

// Mechanisms of joints move freely where they were when the search gave up. A matrix that is
// singular from the start is so at the start of the step.
void fail_if_free(run::Run& run, run::NewtonStatus status, double time_step) {
  const bool singular = status == run::NewtonStatus::singular;
  if (!singular && !run.model->is_loose()) return;
  if (!run.model->is_loose()) {
    run.restore(run.before);
    run.begin_world(time_step);
  }
  RestSearch rest(run, time_step);
  fail_if_free(rest.search(), "there is no equilibrium, since nothing holds a part");
  if (!singular) return;
  fail(run, ErrorKind::singular_matrix, "the stiffness matrix is singular",
       "fix a region of every body, or look for loose or crushed elements");
}

}  // namespace sinew::statics
