#include "sinew/model/actuator.hpp"

#include <limits>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::model {

bool ActuatorModel::holds_motion(CommandKind by) const {
  if (by == CommandKind::input) return joint >= 0;
  return by == CommandKind::motion && (drive == nullptr || !drive->acts_on(by));
}

QuantityName ActuatorModel::input_name() const {
  if (drive != nullptr) return drive->input();
  return joint >= 0 ? kind->inputs[0] : QuantityName{};
}

QuantityName ActuatorModel::quantity(CommandKind by) const {
  if (by == CommandKind::effort) return kind->effort;
  if (by == CommandKind::motion) return kind->motion;
  const QuantityName input = input_name();
  return *input.name == '\0' ? kind->motion : input;
}

Limits ActuatorModel::effort_limits(CommandKind by) const {
  Limits limits = effort;
  if (by == CommandKind::motion && vacuum && limits.min == *vacuum) {
    limits.min = -std::numeric_limits<double>::infinity();
  }
  return limits;
}

void ActuatorModel::check_command(const Command& told) const {
  if (!vacuum || told.kind != CommandKind::effort) return;
  const double lowest = told.signal.lowest();
  if (lowest >= *vacuum) return;
  throw Error(
      ErrorKind::out_of_range, {.item = fmt::format("actuator '{}'", name)},
      fmt::format("a pressure of {:.6g} kPa is below vacuum: the ambient pressure is {:.6g} "
                  "kPa",
                  1e-3 * lowest, -1e-3 * *vacuum),
      fmt::format("give {:.6g} kPa or more, or the chamber's `ambient_pressure`", 1e-3 * *vacuum));
}

std::optional<CommandKind> ActuatorModel::kind_of(std::string_view quantity) const {
  if (controllable() && quantity == kind->effort.name) return CommandKind::effort;
  if (controllable() && quantity == kind->motion.name) return CommandKind::motion;
  const bool known = !quantity.empty() && quantity == input_name().name;
  return known ? std::optional(CommandKind::input) : std::nullopt;
}

}  // namespace sinew::model
