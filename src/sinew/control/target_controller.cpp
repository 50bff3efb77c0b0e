#include "sinew/control/target_controller.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "sinew/constraint/effector.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::control {

TargetController::TargetController(sim::Simulation& simulation, TargetSettings settings)
    : simulation_(simulation), settings_(std::move(settings)) {
  check_settings(simulation_, settings_);
}

void TargetController::set_target(int task, Target target) {
  check_target(simulation_, settings_.tasks.at(static_cast<std::size_t>(task)).effector, target);
  settings_.tasks.at(static_cast<std::size_t>(task)).target = std::move(target);
}

VectorX TargetController::efforts() const {
  VectorX efforts(std::ssize(settings_.actuators));
  for (Eigen::Index k = 0; k < efforts.size(); ++k) {
    efforts[k] = simulation_.actuator(settings_.actuators[static_cast<std::size_t>(k)]).effort;
  }
  return efforts;
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

int TargetController::sensor(int) const { return -1; }
double TargetController::measured_error(int) const {
  return std::numeric_limits<double>::quiet_NaN();
}
std::string TargetController::conflict() const { return {}; }

const std::vector<run::Observable>& TargetController::observables() const {
  static const std::vector<run::Observable> none;
  return none;
}

std::unique_ptr<TargetController> make_controller(sim::Simulation& simulation,
                                                  const ControllerSettings& settings) {
  return settings.make(simulation, settings.targets);
}

}  // namespace sinew::control
