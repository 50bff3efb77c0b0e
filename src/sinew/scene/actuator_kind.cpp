#include "sinew/scene/actuator_kind.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene {

namespace {

// Whether the grammar has been made, in which later kinds would be missing.
bool& actuator_form_is_made() {
  static bool made = false;
  return made;
}

std::vector<const ActuatorKind*>& list_of_actuators() {
  static std::vector<const ActuatorKind*> all = {
      &cable_kind(),        &force_kind(),   &torque_kind(), &motor_kind(),
      &linear_motor_kind(), &chamber_kind(), &spring_kind()};
  return all;
}

}  // namespace

const std::vector<const ActuatorKind*>& actuator_kinds() { return list_of_actuators(); }

void register_actuator_kind(const ActuatorKind& kind) {
  const std::string_view word = kind.word();
  if (std::ranges::find(list_of_actuators(), word, &ActuatorKind::word) !=
      list_of_actuators().end()) {
    throw Error(ErrorKind::duplicate_key, {.item = fmt::format("the kind of actuator '{}'", word)},
                "there is a kind of this word", "choose another word");
  }
  if (actuator_form_is_made()) {
    throw Error(ErrorKind::bad_argument, {.item = fmt::format("the kind '{}'", word)},
                "the grammar is in use", "register kinds before the first scene is read");
  }
  list_of_actuators().push_back(&kind);
}

const ActuatorKind& actuator_kind(std::string_view word) {
  const auto found = std::ranges::find(list_of_actuators(), word, &ActuatorKind::word);
  if (found != list_of_actuators().end()) return **found;
  throw Error(ErrorKind::internal, {}, fmt::format("no kind of actuator has the word '{}'", word));
}

std::vector<std::string> further_bodies(const ActuatorDescription& actuator) {
  if (actuator.kind->bodies == nullptr) return {};
  std::any own = actuator.own;
  return *actuator.kind->bodies(own).names;
}

Form forms::actuator_form() {
  actuator_form_is_made() = true;
  std::vector<Choice> choices;
  for (const ActuatorKind* kind : actuator_kinds()) {
    choices.push_back(
        {.word = kind->word(), .description = kind->description, .table = kind->table()});
  }
  return variants("type", std::move(choices));
}

}  // namespace sinew::scene
