// Controllers of type inverse.
#include <any>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "sinew/control/inverse_controller.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/model.hpp"
#include "sinew/scene/controller_kind.hpp"
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> normal_force_table() {
  return make_table(
      {.name = "normal force of a contact",
       .description = "Limits of the sum of the normal forces at the contact's points.",
       .keys = {{.name = "min",
                 .forms = {quantity(force(), non_negative())},
                 .example = "1 N",
                 .default_text = "0 N",
                 .description = "Smallest normal force."},
                {.name = "max",
                 .forms = {quantity(force(), positive())},
                 .example = "3 N",
                 .description = "Largest normal force. Default: no limit."}}});
}

Form contact_task_form() {
  return table(make_table(
      {.name = "contact goal",
       .description =
           "Goals for the resultant force of one contact. They have priority over targets.",
       .keys = {{.name = "normal_force",
                 .forms = {quantity(force(), positive()), table(normal_force_table())},
                 .example = "{min: 1 N, max: 3 N}",
                 .description = "The normal force, or its limits."},
                {.name = "slip",
                 .forms = {boolean()},
                 .example = "false",
                 .default_text = "true",
                 .description = "Whether the contact may slip. If false, the controller keeps the "
                                "resultant inside the friction cone."},
                {.name = "reserve",
                 .forms = {quantity(plain_number(), non_negative())},
                 .example = "0.2",
                 .default_text = "0",
                 .description = "Fraction of the friction cone to keep in reserve: |F_t| <= (1 - "
                                "reserve) mu F_n. Less than 1."}}}));
}

std::shared_ptr<const KeyTable> regularisation_table() {
  return make_table(
      {.name = "regularisation",
       .description = "Choice among efforts that serve the targets equally well.",
       .keys = {
           {.name = "of",
            .forms = {choice({{"change", "The change from the last efforts; no bias at rest."},
                              {"effort", "The efforts; biases the effector."}})},
            .example = "change",
            .default_text = "change",
            .description = "Quantity to minimise."},
           {.name = "epsilon",
            .forms = {quantity(plain_number(), positive())},
            .example = "1e-5",
            .description =
                "Its weight relative to the tracking error. Default: chosen by the controller."}}});
}

std::shared_ptr<const KeyTable> inverse_table() {
  return make_table({.name = "controller: type inverse",
                     .description = "Inverse control: computes in each step the efforts that move "
                                    "the effectors to their targets.",
                     .keys = {tasks_key(false),
                              {.name = "contacts",
                               .forms = {names(contact_task_form(), 1, "contacts")},
                               .example = "{grip: {normal_force: {min: 1 N, max: 3 N}}}",
                               .description = "Goals for contact forces, by name of the contact."},
                              driven_key(),
                              {.name = "regularisation",
                               .forms = {table(regularisation_table())},
                               .example = "{of: change}",
                               .default_text = "{}",
                               .description = "Choice among equivalent efforts."}}});
}

}  // namespace
}  // namespace forms

namespace {

using control::Regularisation;

ContactTaskDescription read_contact_task(const Node::Entry& entry, const Form& form) {
  ContactTaskDescription task;
  task.contact = entry.key;
  task.place = entry.key_place;
  const Fields fields(entry.value, form);
  control::ContactTask& asked = task.asked;
  if (const Node* force = fields.find("normal_force")) {
    if (fields.form("normal_force").shape == Shape::quantity) {
      fields.read("normal_force", asked.normal_min);
      asked.normal_max = asked.normal_min;
    } else {
      const Fields limits = fields.below("normal_force");
      limits.read("min", asked.normal_min);
      limits.read("max", asked.normal_max);
      if (asked.normal_max < asked.normal_min) {
        throw Error(
            ErrorKind::contradictory_limits, force->place(),
            fmt::format("min, {:g} N, is above max, {:g} N", asked.normal_min, asked.normal_max),
            "swap them");
      }
    }
  }
  bool slip = true;
  double reserve = 0.0;
  fields.read("slip", slip);
  const bool reserved = fields.read("reserve", reserve);
  if (reserved && !(reserve < 1.0)) {
    throw Error(ErrorKind::out_of_range, fields.place("reserve"),
                fmt::format("{:g} leaves no friction", reserve), "give a number below 1");
  }
  if (reserved || !slip) asked.reserve = reserve;
  return task;
}

std::any read_inverse(const ControllerEntry& entry) {
  InverseDescription inverse;
  const Fields preference = entry.fields.below("regularisation");
  preference.read_choice("of", inverse.settings.regularisation,
                         {{"change", Regularisation::change}, {"effort", Regularisation::effort}});
  preference.read("epsilon", inverse.settings.epsilon);
  if (const Node* contacts = entry.fields.find("contacts")) {
    const Form& tasks = entry.fields.form("contacts").items.front();
    for (const Node::Entry& task : contacts->entries()) {
      inverse.contacts.push_back(read_contact_task(task, tasks));
    }
  }
  if (entry.controller.tasks.empty() && inverse.contacts.empty()) {
    throw Error(ErrorKind::missing_key, entry.controller.place,
                fmt::format("the controller '{}' steers nothing", entry.controller.name),
                "give it effectors and their targets, or contacts and their forces");
  }
  return inverse;
}

control::ControllerSettings build_inverse(const ControllerSite& site) {
  const auto& inverse = *site.controller.as<InverseDescription>();
  control::InverseSettings own = inverse.settings;
  for (const ContactTaskDescription& task : inverse.contacts) {
    own.contacts.push_back(task.asked);
    own.contacts.back().contact = site.model.contact_index(task.contact);
  }
  return control::settings_for<control::InverseController>(site.targets, std::move(own));
}

}  // namespace

const ControllerKind& inverse_kind() {
  static const ControllerKind kind{.word = "inverse",
                                   .description = "One-step inverse control.",
                                   .table = forms::inverse_table,
                                   .read = read_inverse,
                                   .build = build_inverse};
  return kind;
}

}  // namespace sinew::scene
