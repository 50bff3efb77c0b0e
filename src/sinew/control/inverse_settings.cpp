#include "sinew/control/inverse_settings.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
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

void check_contact(const model::Model& model, const ContactTask& task) {
  const auto& contact = model.contact(task.contact);
  const Location place{.item = "contact '" + contact.name() + "'"};
  if (!(task.normal_min >= 0.0) || !std::isfinite(task.normal_min)) {
    throw Error(ErrorKind::out_of_range, place,
                fmt::format("a normal force of {:g} N is asked for: contacts push and do not pull",
                            task.normal_min),
                "give 0 N or more");
  }
  if (!(task.normal_max >= task.normal_min) || !(task.normal_max > 0.0)) {
    throw Error(ErrorKind::out_of_range, place,
                fmt::format("the largest normal force asked for, {:g} N, is not above the least, "
                            "{:g} N, and above 0 N",
                            task.normal_max, task.normal_min),
                "give min below max; both the same ask for one force");
  }
  if (!task.reserve) return;
  if (!(*task.reserve >= 0.0) || !(*task.reserve < 1.0)) {
    throw Error(ErrorKind::out_of_range, place,
                fmt::format("a reserve of {:g} of the friction is asked for", *task.reserve),
                "give a number from 0 to below 1");
  }
  if (contact.friction().sticking > 0.0) return;
  throw Error(ErrorKind::out_of_range, place,
              "it is not to slip, and has no friction that would hold it",
              "give the contact a friction coefficient, or let it slip");
}

void check_contacts(const model::Model& model, const std::vector<ContactTask>& tasks) {
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    check_contact(model, tasks[k]);
    for (std::size_t j = 0; j < k; ++j) {
      if (tasks[j].contact != tasks[k].contact) continue;
      const std::string& name = model.contact(tasks[k].contact).name();
      throw Error(ErrorKind::duplicate_key, {.item = "contact '" + name + "'"},
                  "its force is asked for twice", "name each contact once");
    }
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

void check_settings(const sim::Simulation& simulation, InverseSettings& settings) {
  const model::Model& model = simulation.model();
  if (settings.tasks.empty() && settings.contacts.empty()) {
    throw Error(ErrorKind::no_effectors, {.item = "controller"}, "there is no effector to steer",
                "name at least one effector and its target, or a contact and its force");
  }
  check_contacts(model, settings.contacts);
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
  for (const EffectorTask& task : settings.tasks) {
    check_target(simulation, task.effector, task.target);
    const auto& effector = model.effector(task.effector);
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
      if (!(weight >= 0.0) || !std::isfinite(weight)) {
        throw Error(ErrorKind::out_of_range, {.item = "weights of '" + effector.name() + "'"},
                    fmt::format("a weight is {:g}", weight), "give zero or more");
      }
    }
  }
}

}  // namespace sinew::control
