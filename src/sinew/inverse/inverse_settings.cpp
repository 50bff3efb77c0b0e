#include "sinew/inverse/inverse_settings.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/core/error.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::inverse {

namespace {

// In sizes of the robot.
constexpr double kFarthest = 100.0;

}  // namespace

void check_target(const sim::Simulation& simulation, int effector, const Target& target) {
  const sim::Model& model = simulation.model();
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

void check_settings(const sim::Simulation& simulation, InverseSettings& settings) {
  const sim::Model& model = simulation.model();
  if (settings.tasks.empty()) {
    throw Error(ErrorKind::no_effectors, {.item = "controller"}, "there is no effector to steer",
                "name at least one effector and its target");
  }
  if (settings.actuators.empty()) {
    for (std::size_t i = 0; i < model.actuators().size(); ++i) {
      if (model.actuators()[i].controllable()) settings.actuators.push_back(static_cast<int>(i));
    }
  }
  if (settings.actuators.empty()) {
    throw Error(ErrorKind::no_actuators, {.item = "controller"}, "the robot has no actuators",
                "add a cable");
  }
  for (const int index : settings.actuators) {
    const auto& actuator = model.actuators().at(static_cast<std::size_t>(index));
    if (actuator.controllable()) continue;
    throw Error(ErrorKind::wrong_actuator_type, {.item = "actuator '" + actuator.name + "'"},
                "a spring's tension follows its stretch, a controller cannot choose it",
                "leave it out of the controller's actuators");
  }
  for (const double value : {settings.epsilon, settings.largest_step, settings.tolerance}) {
    if (!(value > 0.0)) {
      throw Error(
          ErrorKind::out_of_range, {.item = "controller"},
          fmt::format("epsilon, largest_step and tolerance must be positive; one is {:g}", value),
          "leave it out for the default");
    }
  }
  for (const Task& task : settings.tasks) {
    check_target(simulation, task.effector, task.target);
    const auto& effector = model.effector(task.effector);
    const auto given = static_cast<int>(task.weights.size());
    if (given != 1 && given != effector.row_count()) {
      throw Error(ErrorKind::wrong_length, {.item = "weights of '" + effector.name() + "'"},
                  fmt::format("{} weights for {} directions", given, effector.row_count()),
                  "give one weight, or one for each direction");
    }
    for (const double weight : task.weights) {
      if (!(weight >= 0.0) || !std::isfinite(weight)) {
        throw Error(ErrorKind::out_of_range, {.item = "weights of '" + effector.name() + "'"},
                    fmt::format("a weight is {:g}", weight), "give zero or more");
      }
    }
  }
}

}  // namespace sinew::inverse
