#include "sinew/model/model.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/chamber.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/joint.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/instrument_model.hpp"
#include "sinew/model/model_parts.hpp"
#include "sinew/model/named_index.hpp"

namespace sinew::model {

namespace {

std::uint64_t fingerprint_of(const std::vector<NamedHash>& parts) {
  ValueHash hash;
  for (const NamedHash& part : parts) hash.add(part.name, part.hash);
  return hash.value();
}

}  // namespace

Model::Model(ModelData data)
    : data_(std::move(data)),
      errors_last_(
          data_.step.dynamic() ||
          std::ranges::any_of(data_.bodies, [](const auto& b) { return b->has_memory(); })),
      parts_(list_parts(data_)),
      fingerprint_(fingerprint_of(parts_)) {}

std::vector<Parameter> Model::parameters() const { return list_parameters(data_); }

int Model::body_index(std::string_view name) const {
  if (const auto other = data_.body_names.find(name); other != data_.body_names.end()) {
    if (other->second != kWorld) return other->second;
    throw Error(ErrorKind::unknown_name, {.item = std::string(name)},
                "this link is fixed and without geometry, so it is part of the world and no body",
                "ask for a link with geometry or inertia, or add an effector where the link is");
  }
  return index_of_name(data_.bodies, name, "body", [](const auto& b) { return b->name(); });
}

int Model::actuator_index(std::string_view name) const {
  return index_of_name(data_.actuators, name, "actuator", [](const auto& a) { return a.name; });
}

int Model::effector_index(std::string_view name) const {
  return index_of_name(data_.effectors, name, "effector", [](const auto& e) { return e.name; });
}

int Model::contact_index(std::string_view name) const {
  return index_of_name(data_.contacts, name, "contact", [](const auto& c) { return c.name; });
}

int Model::joint_index(std::string_view name) const {
  return index_of_name(data_.joints, name, "joint", [](const auto& j) { return j.name; });
}

int Model::load_index(std::string_view name) const {
  return index_of_name(data_.loads, name, "load", [](const auto& l) { return l.name; });
}

int Model::mass_index(std::string_view name) const {
  return index_of_name(data_.masses, name, "mass", [](const auto& m) { return m.name; });
}

int Model::probe_index(std::string_view name) const {
  return index_of_name(data_.probes, name, "probe", [](const auto& p) { return p->name(); });
}

const mechanics::BodyModel& Model::body(int index) const {
  return *data_.bodies.at(static_cast<std::size_t>(index));
}

const constraint::Constraint& Model::constraint(int index) const {
  return *data_.constraints.at(static_cast<std::size_t>(index));
}

const constraint::Probe& Model::probe(int index) const {
  return *data_.probes.at(static_cast<std::size_t>(index));
}

const constraint::Effector& Model::effector(int index) const {
  const int number = data_.effectors.at(static_cast<std::size_t>(index)).constraint;
  return dynamic_cast<const constraint::Effector&>(data_.constraint(number));
}

const constraint::Contact& Model::contact(int index) const {
  const int number = data_.contacts.at(static_cast<std::size_t>(index)).constraint;
  return dynamic_cast<const constraint::Contact&>(data_.constraint(number));
}

const constraint::Tie* Model::tie(int joint) const {
  const int number = data_.joints.at(static_cast<std::size_t>(joint)).constraint;
  return dynamic_cast<const constraint::Tie*>(&data_.constraint(number));
}

const constraint::Joint* Model::joint(int joint) const {
  const int number = data_.joints.at(static_cast<std::size_t>(joint)).constraint;
  return dynamic_cast<const constraint::Joint*>(&data_.constraint(number));
}

const constraint::Cable* Model::cable(int actuator) const {
  const int number = data_.actuators.at(static_cast<std::size_t>(actuator)).constraint;
  return dynamic_cast<const constraint::Cable*>(&data_.constraint(number));
}

const constraint::Chamber* Model::chamber(int actuator) const {
  const int number = data_.actuators.at(static_cast<std::size_t>(actuator)).constraint;
  return dynamic_cast<const constraint::Chamber*>(&data_.constraint(number));
}

}  // namespace sinew::model
