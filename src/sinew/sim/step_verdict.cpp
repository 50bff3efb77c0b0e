#include "sinew/sim/step_verdict.hpp"

#include "sinew/sim/run.hpp"
#include "sinew/sim/step_tolerances.hpp"

namespace sinew::sim {

bool is_balanced(const Run& run) {
  if (!run.report.physical) return false;
  const bool newton = run.model->step().method == Method::newton;
  if (newton && run.report.newton == NewtonStatus::converged) return true;
  const bool searched = newton && run.controller == nullptr;
  return run.report.relative_residual <= (searched ? kSearched : kBalanced);
}

StepStatus failure_status(const Run& run) {
  return run.report.physical ? StepStatus::not_in_equilibrium : StepStatus::unphysical;
}

}  // namespace sinew::sim
