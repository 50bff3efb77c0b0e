#include "sinew/sim/model_builder.hpp"

#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/constraint.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/sim/add_parts.hpp"
#include "sinew/sim/body_holding.hpp"
#include "sinew/sim/held_rows.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/stiffness_pairs.hpp"

namespace sinew::sim {

namespace {

void check_event_driven(const StepSettings& settings) {
  const auto refuse = [](const char* item, const char* what, const char* remedy) {
    throw Error(ErrorKind::not_in_this_version, {.item = item}, what, remedy);
  };
  if (settings.adaptive) {
    refuse("solver.adaptive", "event-driven integration divides steps by its impacts alone",
           "leave `adaptive` out, or choose bdf2");
  }
  if (settings.method != Method::newton) {
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

ModelBuilder::ModelBuilder(StepSettings settings) {
  if (!(settings.time_step > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "time_step"},
                fmt::format("the time step is {:g} s", settings.time_step),
                "give a positive time such as 10 ms");
  }
  if (settings.event_driven()) check_event_driven(settings);
  data_.step = settings;
}

int ModelBuilder::add_body(std::unique_ptr<mechanics::BodyModel> body, const Location& place) {
  const int index = sim::add_body(data_, std::move(body));
  places_.push_back(place);
  return index;
}

void ModelBuilder::name_body(const std::string& name, int body) { data_.body_names[name] = body; }

void ModelBuilder::add_base_motion(const BaseMotion& motion, const Location& place) {
  sim::add_base_motion(data_, motion, place);
}

int ModelBuilder::add_cable(const CableSettings& settings) {
  return sim::add_cable(data_, settings);
}

int ModelBuilder::add_force(const ForceSettings& settings) {
  return sim::add_force(data_, settings);
}

int ModelBuilder::add_torque(const TorqueSettings& settings) {
  return sim::add_torque(data_, settings);
}

int ModelBuilder::add_chamber(const ChamberSettings& settings) {
  return sim::add_chamber(data_, settings);
}

int ModelBuilder::add_load(const LoadSettings& settings) { return sim::add_load(data_, settings); }

int ModelBuilder::add_spring(const SpringLineSettings& settings) {
  return sim::add_spring(data_, settings);
}

int ModelBuilder::add_effector(const EffectorSettings& settings) {
  return sim::add_effector(data_, settings);
}

int ModelBuilder::add_contact(const ContactSettings& settings) {
  return sim::add_contact(data_, settings);
}

int ModelBuilder::add_weld(const WeldSettings& settings) { return sim::add_weld(data_, settings); }

int ModelBuilder::add_joint(const JointSettings& settings) {
  return sim::add_joint(data_, settings);
}

int ModelBuilder::add_motor(const MotorSettings& settings) {
  return sim::add_motor(data_, settings);
}

int ModelBuilder::add_probe(const ProbeSettings& settings) {
  return sim::add_probe(data_, settings);
}

std::shared_ptr<const Model> ModelBuilder::build() {
  check_held_radius(data_);
  hold_bodies(data_, places_);
  add_couplings(data_);
  // Transient rows come after all others, which keep their numbers in a step's problem.
  for (const ContactModel& contact : data_.contacts) {
    data_.constraint(contact.constraint).declare(data_.rows, data_.stiffness_pairs);
  }
  for (std::size_t i = 0; i < data_.bodies.size(); ++i) {
    data_.bodies[i]->finish(static_cast<int>(i), data_.rows, data_.stiffness_pairs);
  }
  list_geometric_stiffness(data_);
  auto model = std::make_shared<const Model>(std::move(data_));
  data_ = {};
  places_.clear();
  return model;
}

}  // namespace sinew::sim
