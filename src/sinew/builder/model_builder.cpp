#include "sinew/builder/model_builder.hpp"

#include <utility>

#include <fmt/format.h>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/body_holding.hpp"
#include "sinew/builder/stiffness_pairs.hpp"
#include "sinew/constraint/constraint.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/held_rows.hpp"
#include "sinew/model/model.hpp"

namespace sinew::builder {

namespace {

void check_event_driven(const model::StepSettings& settings) {
  const auto refuse = [](const char* item, const char* what, const char* remedy) {
    throw Error(ErrorKind::not_in_this_version, {.item = item}, what, remedy);
  };
  if (settings.adaptive) {
    refuse("solver.adaptive", "event-driven integration divides steps by its impacts alone",
           "leave `adaptive` out, or choose bdf2");
  }
  if (settings.method != model::Method::newton) {
    refuse("solver.method", "event-driven integration solves each part to its tolerance",
           "write `method: newton`, or choose bdf2");
  }
  if (!(settings.restitution >= 0.0 && settings.restitution <= 1.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "integrator.restitution"},
                fmt::format("the restitution is {:g}", settings.restitution),
                "give 0 (no rebound) to 1 (elastic)");
  }
}

}  // namespace

ModelBuilder::ModelBuilder(model::StepSettings settings) {
  if (!(settings.time_step > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "time_step"},
                fmt::format("the time step is {:g} s", settings.time_step),
                "give a positive time such as 10 ms");
  }
  if (settings.event_driven()) check_event_driven(settings);
  data_.step = settings;
}

int ModelBuilder::add_body(std::unique_ptr<mechanics::BodyModel> body, const Location& place) {
  const int index = builder::add_body(data_, std::move(body));
  places_.push_back(place);
  return index;
}

void ModelBuilder::name_body(const std::string& name, int body) { data_.body_names[name] = body; }

void ModelBuilder::add_base_motion(const model::BaseMotion& motion, const Location& place) {
  builder::add_base_motion(data_, motion, place);
}

int ModelBuilder::add_cable(const CableSettings& settings) {
  return builder::add_cable(data_, settings);
}

int ModelBuilder::add_force(const ForceSettings& settings) {
  return builder::add_force(data_, settings);
}

int ModelBuilder::add_torque(const TorqueSettings& settings) {
  return builder::add_torque(data_, settings);
}

int ModelBuilder::add_chamber(const ChamberSettings& settings) {
  return builder::add_chamber(data_, settings);
}

int ModelBuilder::add_load(const LoadSettings& settings) {
  return builder::add_load(data_, settings);
}

int ModelBuilder::add_spring(const SpringLineSettings& settings) {
  return builder::add_spring(data_, settings);
}

int ModelBuilder::add_effector(const EffectorSettings& settings) {
  return builder::add_effector(data_, settings);
}

int ModelBuilder::add_contact(const ContactSettings& settings) {
  return builder::add_contact(data_, settings);
}

int ModelBuilder::add_weld(const WeldSettings& settings) {
  return builder::add_weld(data_, settings);
}

int ModelBuilder::add_joint(const JointSettings& settings) {
  return builder::add_joint(data_, settings);
}

int ModelBuilder::add_motor(const MotorSettings& settings) {
  return builder::add_motor(data_, settings);
}

int ModelBuilder::add_probe(const ProbeSettings& settings) {
  return builder::add_probe(data_, settings);
}

std::shared_ptr<const model::Model> ModelBuilder::build() {
  model::check_held_radius(data_);
  hold_bodies(data_, places_);
  add_couplings(data_);
  // Transient rows come after all others, which keep their numbers in a step's problem.
  for (const model::ContactModel& contact : data_.contacts) {
    data_.constraint(contact.constraint).declare(data_.rows, data_.stiffness_pairs);
  }
  for (std::size_t i = 0; i < data_.bodies.size(); ++i) {
    data_.bodies[i]->finish(static_cast<int>(i), data_.rows, data_.stiffness_pairs);
  }
  list_geometric_stiffness(data_);
  auto model = std::make_shared<const model::Model>(std::move(data_));
  data_ = {};
  places_.clear();
  return model;
}

}  // namespace sinew::builder
