#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

// Name of the status in an estimator's observables.
constexpr const char* kTakenName = "status";

void read_force_place(const Fields& force, UnknownDescription& unknown) {
  force.read("body", unknown.body);
  force.read("point", unknown.point);
  unknown.where_place = force.place("point");
  read_outside(force, unknown.outside);
}

void read_effort_place(const Fields& effort, UnknownDescription& unknown) {
  effort.read("actuator", unknown.actuator);
  unknown.where_place = effort.place("actuator");
  effort.read_choice("command", unknown.command_known, {{"known", true}, {"unknown", false}});
}

void read_stiffness_place(const Fields& stiffness, UnknownDescription& unknown) {
  stiffness.read("body", unknown.body);
  unknown.where_place = stiffness.place("body");
}

UnknownDescription read_unknown(const Node::Entry& entry, const std::vector<Form>& forms) {
  UnknownDescription unknown;
  unknown.name = entry.key;
  unknown.place = entry.key_place;
  if (unknown.name == kTakenName) {
    throw Error(ErrorKind::duplicate_key, unknown.place,
                "'status' is what the estimator's own status is called", "choose another name");
  }
  const Form& form = select_form(entry.value, forms, {});
  const Fields fields(entry.value, form);
  fields.read("prior", unknown.prior);
  const Fields where = fields.below(form.telltale);
  if (form.telltale == "force") {
    read_force_place(where, unknown);
  } else {
    unknown.quantity = form.telltale;
    if (unknown.is_stiffness()) {
      read_stiffness_place(where, unknown);
    } else {
      read_effort_place(where, unknown);
    }
  }
  unknown.walk = unknown.is_stiffness() ? 0.0 : unknown.prior;
  fields.read("walk", unknown.walk);
  return unknown;
}

// Reads a list of names without duplicates.
void read_names(const Fields& fields, const char* key, std::vector<std::string>& names,
                std::vector<Location>& places) {
  const Node* list = fields.find(key);
  if (list == nullptr) return;
  for (const Node& name : list->items()) {
    if (std::ranges::find(names, name.spelling()) != names.end()) {
      throw Error(ErrorKind::duplicate_key, name.place(),
                  fmt::format("{} is named twice", show(name.spelling())), "name it once");
    }
    names.push_back(name.spelling());
    places.push_back(name.place());
  }
}

}  // namespace

EstimatorDescription read_estimator(const Node::Entry& entry) {
  EstimatorDescription estimator;
  estimator.name = entry.key;
  estimator.place = entry.key_place;
  const Form& form = form_of(grammar(), "estimators", Shape::names).items.front();
  const Fields fields(entry.value, form);
  std::vector<Location> load_places;
  read_names(fields, "sensors", estimator.sensors, estimator.sensor_places);
  read_names(fields, "unknown_loads", estimator.unknown_loads, load_places);
  fields.read("inertia", estimator.inertia);
  fields.read("rank", estimator.rank);
  const std::vector<Form>& unknown = fields.form("unknowns").items;
  for (const Node::Entry& one : fields.find("unknowns")->entries()) {
    estimator.unknowns.push_back(read_unknown(one, unknown));
  }
  return estimator;
}

}  // namespace sinew::scene
