#include "sinew/scene/actuator_kind.hpp"

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/kind_list.hpp"

namespace sinew::scene {

namespace {

KindList<ActuatorKind>& kinds_of_actuators() {
  static KindList<ActuatorKind> list("actuator",
                                     {&cable_kind(), &force_kind(), &torque_kind(), &motor_kind(),
                                      &linear_motor_kind(), &chamber_kind(), &spring_kind()});
  return list;
}

}  // namespace

void register_actuator_kind(const ActuatorKind& kind) { kinds_of_actuators().add(kind); }

const ActuatorKind& actuator_kind(std::string_view word) { return kinds_of_actuators().get(word); }

std::vector<std::string> further_bodies(const ActuatorDescription& actuator) {
  if (actuator.kind->bodies == nullptr) return {};
  std::any own = actuator.own;
  return *actuator.kind->bodies(own).names;
}

Form forms::actuator_form() { return variants("type", kinds_of_actuators().choices()); }

}  // namespace sinew::scene
