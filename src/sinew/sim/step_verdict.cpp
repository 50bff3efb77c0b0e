#include "sinew/sim/step_verdict.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/sim/run.hpp"
#include "sinew/sim/step_tolerances.hpp"

namespace sinew::sim {

namespace {

// Resultant of all forces and moments that contradicts an equilibrium, relative to the forces.
constexpr double kUnbalanced = 0.02;

}  // namespace

bool is_balanced(const Run& run) {
  const StepReport& report = run.report;
  if (!report.physical) return false;
  if (run.model->step().method == Method::newton) {
    return report.newton == NewtonStatus::converged;
  }
  return report.relative_residual <= kLag.residual;
}

bool reactions_balance(Run& run) {
  Bodies& bodies = run.world.bodies();
  Vector3 about = Vector3::Zero();  // near the robot, or rounding of the force would be a moment
  for (const auto& body : bodies.all()) {
    if (body->positions().rows() > 0) about = body->positions().row(0).transpose();
  }
  const mechanics::Wrench left = bodies.unbalanced(run.effort, about);
  const double largest = std::max(left.force.norm(), left.moment.norm() / run.model->size());
  const double told = std::sqrt(static_cast<double>(bodies.size())) * run.report.residual;
  return largest <= kUnbalanced * bodies.force_scale() + told;
}

StepStatus failure_status(const Run& run) {
  return run.report.physical ? StepStatus::not_in_equilibrium : StepStatus::unphysical;
}

}  // namespace sinew::sim
