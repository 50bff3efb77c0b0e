#include "sinew/scene/controller_kind.hpp"

#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/kind_list.hpp"

namespace sinew::scene {

namespace {

KindList<ControllerKind>& kinds_of_controllers() {
  static KindList<ControllerKind> list("controller", {&inverse_kind(), &closed_loop_kind()});
  return list;
}

}  // namespace

void register_controller_kind(const ControllerKind& kind) { kinds_of_controllers().add(kind); }

const ControllerKind& controller_kind(std::string_view word) {
  return kinds_of_controllers().get(word);
}

Form forms::controller_form() {
  std::vector<Choice> choices = kinds_of_controllers().choices();
  choices.push_back({.word = "policy", .description = "A learnt policy.", .later = true});
  return variants("type", std::move(choices));
}

}  // namespace sinew::scene
