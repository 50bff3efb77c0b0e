#include "sinew/sim/actuator.hpp"

namespace sinew::sim {

const char* actuator_type_name(ActuatorType type) {
  switch (type) {
    case ActuatorType::cable:
      return "cable";
    case ActuatorType::force:
      return "force";
    case ActuatorType::pressure:
      return "pressure";
    case ActuatorType::spring:
      return "spring";
    case ActuatorType::torque:
      return "torque";
  }
  return "unknown";
}

QuantityName ActuatorModel::effort_name() const {
  switch (type) {
    case ActuatorType::force:
      return {"force", "N"};
    case ActuatorType::pressure:
      return {"pressure", "Pa"};
    case ActuatorType::torque:
      return {"torque", "N m"};
    case ActuatorType::cable:
    case ActuatorType::spring:
      return {"tension", "N"};
  }
  return {};
}

QuantityName ActuatorModel::motion_name() const {
  if (type == ActuatorType::pressure) return {"volume_growth", "m^3"};
  if (type == ActuatorType::torque) return {"angle", "rad"};
  return {"displacement", "m"};
}

QuantityName ActuatorModel::quantity(CommandKind kind) const {
  if (kind == CommandKind::effort) return effort_name();
  if (kind == CommandKind::motion || drive == nullptr) return motion_name();
  return drive->input();
}

std::optional<CommandKind> ActuatorModel::kind_of(std::string_view quantity) const {
  if (controllable() && quantity == effort_name().name) return CommandKind::effort;
  if (controllable() && quantity == motion_name().name) return CommandKind::motion;
  const bool known = drive != nullptr && !quantity.empty() && quantity == drive->input().name;
  return known ? std::optional(CommandKind::input) : std::nullopt;
}

}  // namespace sinew::sim
