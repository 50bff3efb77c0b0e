#include "sinew/control/target_controller.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "sinew/constraint/effector.hpp"
#include "sinew/control/closed_loop.hpp"
#include "sinew/control/inverse_controller.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::control {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TargetController::TargetController(sim::Simulation& simulation, InverseSettings settings)
    : simulation_(simulation), settings_(std::move(settings)) {
  check_settings(simulation_, settings_);
}

void TargetController::set_target(int task, Target target) {
  check_target(simulation_, settings_.tasks.at(static_cast<std::size_t>(task)).effector, target);
  settings_.tasks.at(static_cast<std::size_t>(task)).target = std::move(target);
}

// Evaluates the present configuration, which may be a restored one whose rows no step has formed
// yet.
double TargetController::error(int task) const {
  const EffectorTask& asked = settings_.tasks.at(static_cast<std::size_t>(task));
  const auto& effector = simulation_.model().effector(asked.effector);
  const auto& configuration = simulation_.configuration();
  VectorX goal(effector.row_count()), now(effector.row_count());
  effector.target_delta(configuration, asked.target.at(simulation_.time()), goal);
  effector.target_delta(configuration, effector.value(configuration), now);
  for (Eigen::Index k = 0; k < goal.size(); ++k) {
    if (!(asked.weight(k) > 0.0)) goal[k] = now[k];
  }
  return (goal - now).norm();
}

double TargetController::error() const {
  double worst = 0.0;
  for (std::size_t k = 0; k < settings_.tasks.size(); ++k) {
    worst = std::max(worst, error(static_cast<int>(k)));
  }
  return worst;
}

double TargetController::measured_error(int) const { return kNothing; }
double TargetController::force_error(int) const { return kNothing; }
double TargetController::predicted_error() const { return kNothing; }
std::string TargetController::conflict() const { return {}; }

const std::optional<law::Certificate>& TargetController::certificate() const {
  static const std::optional<law::Certificate> none;
  return none;
}

std::unique_ptr<TargetController> make_controller(sim::Simulation& simulation,
                                                  InverseSettings settings) {
  if (settings.feedback) return std::make_unique<ClosedLoop>(simulation, std::move(settings));
  return std::make_unique<InverseController>(simulation, std::move(settings));
}

}  // namespace sinew::control
