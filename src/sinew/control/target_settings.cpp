#include "sinew/control/target_settings.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::control {

namespace {

// Relative to the size of the robot.
constexpr double kFarthest = 100.0;
// Later priorities would be lost in rounding.
constexpr int kLastPriority = 3;

void check_actuators(const model::Model& model, std::vector<int>& actuators) {
  if (actuators.empty()) {
    for (std::size_t i = 0; i < model.actuators().size(); ++i) {
      if (model.actuators()[i].controllable()) actuators.push_back(static_cast<int>(i));
    }
  }
  if (actuators.empty()) {
    throw Error(ErrorKind::no_actuators, {.item = "controller"}, "the robot has no actuators",
                "add a cable");
  }
  for (const int index : actuators) {
    const auto& actuator = model.actuators().at(static_cast<std::size_t>(index));
    if (actuator.controllable()) continue;
    throw Error(ErrorKind::wrong_actuator_type, {.item = "actuator '" + actuator.name + "'"},
                "a spring's tension follows its stretch, a controller cannot choose it",
                "leave it out of the controller's actuators");
  }
}

void check_task(const constraint::Effector& effector, const EffectorTask& task) {
  const auto given = static_cast<int>(task.weights.size());
  if (given != 1 && given != effector.row_count()) {
    throw Error(ErrorKind::wrong_length, {.item = "weights of '" + effector.name() + "'"},
                fmt::format("{} weights for {} directions", given, effector.row_count()),
                "give one weight, or one for each direction");
  }
  if (task.priority < 1 || task.priority > kLastPriority) {
    throw Error(ErrorKind::out_of_range, {.item = "priority of '" + effector.name() + "'"},
                fmt::format("it is {}", task.priority),
                fmt::format("give 1 (first) to {}", kLastPriority));
  }
  for (const double weight : task.weights) {
    if (weight >= 0.0 && std::isfinite(weight)) continue;
    throw Error(ErrorKind::out_of_range, {.item = "weights of '" + effector.name() + "'"},
                fmt::format("a weight is {:g}", weight), "give zero or more");
  }
}

}  // namespace

void check_target(const sim::Simulation& simulation, int effector, const Target& target) {
  const model::Model& model = simulation.model();
  if (model.effector(effector).kind() != constraint::EffectorKind::point) return;
  const double distance = target.farthest_from(simulation.effector_value(effector));
  const double size = model.size();
  if (!(distance > kFarthest * size)) return;
  throw Error(ErrorKind::suspicious_unit,
              {.item = "target of '" + model.effector(effector).name() + "'"},
              fmt::format("it is {:.4g} m from the effector, and the robot is {:.3g} m large",
                          distance, size),
              fmt::format("give metres: 0.18 for 180 mm; as millimetres it is {:.4g} m away",
                          1e-3 * distance));
}

void check_settings(const sim::Simulation& simulation, TargetSettings& settings) {
  const model::Model& model = simulation.model();
  check_actuators(model, settings.actuators);
  if (!(settings.tolerance > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "controller"},
                fmt::format("the tolerance must be positive; it is {:g}", settings.tolerance),
                "leave it out for the default");
  }
  for (const EffectorTask& task : settings.tasks) {
    check_target(simulation, task.effector, task.target);
    check_task(model.effector(task.effector), task);
  }
}

}  // namespace sinew::control
