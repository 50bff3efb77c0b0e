#include "sinew/control/inverse_settings.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/model.hpp"

namespace sinew::control {

namespace {

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

void check_settings(const model::Model& model, const TargetSettings& targets,
                    const InverseSettings& settings) {
  if (targets.tasks.empty() && settings.contacts.empty()) {
    throw Error(ErrorKind::no_effectors, {.item = "controller"}, "there is no effector to steer",
                "name at least one effector and its target, or a contact and its force");
  }
  check_contacts(model, settings.contacts);
  for (const double value : {settings.epsilon, settings.largest_step, targets.tolerance}) {
    if (value > 0.0) continue;
    throw Error(
        ErrorKind::out_of_range, {.item = "controller"},
        fmt::format("epsilon, largest_step and tolerance must be positive; one is {:g}", value),
        "leave it out for the default");
  }
}

}  // namespace sinew::control
