#include "sinew/step/step_verdict.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/run/run.hpp"
#include "sinew/run/step_tolerances.hpp"

namespace sinew::step {

namespace {

// Resultant of all forces and moments that contradicts an equilibrium, relative to the forces.
constexpr double kUnbalanced = 0.02;

}  // namespace

bool is_balanced(const run::Run& run) {
  const run::StepReport& report = run.report;
  if (!report.physical) return false;
  if (run.model->step().method == model::Method::newton) {
    return report.newton == run::NewtonStatus::converged;
  }
  return report.relative_residual <= run::kLag.residual;
}

bool reactions_balance(run::Run& run) {
  world::Bodies& bodies = run.world.bodies();
  Vector3 about = Vector3::Zero();  // near the robot, or rounding of the force would be a moment
  for (const auto& body : bodies.all()) {
    if (body->positions().rows() > 0) about = body->positions().row(0).transpose();
  }
  const mechanics::Wrench left = bodies.unbalanced(run.effort, about);
  const double largest = std::max(left.force.norm(), left.moment.norm() / run.model->size());
  const double told = std::sqrt(static_cast<double>(bodies.size())) * run.report.residual;
  return largest <= kUnbalanced * bodies.force_scale() + told;
}

run::StepStatus failure_status(const run::Run& run) {
  return run.report.physical ? run::StepStatus::not_in_equilibrium : run::StepStatus::unphysical;
}

}  // namespace sinew::step
