// State and inputs of a Simulation as values.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/step/controller.hpp"

namespace sinew::sim {

namespace {

void check_count(const char* what, std::size_t expected, std::size_t got) {
  if (expected == got) return;
  throw Error(ErrorKind::wrong_length, {.item = what},
              fmt::format("{} are given, this robot has {}", got, expected),
              "take them from a simulation of the same model");
}

fem::FemBody* fem_of(const std::unique_ptr<mechanics::Body>& body) {
  return dynamic_cast<fem::FemBody*>(body.get());
}

}  // namespace

// Allocates nothing where `state` has the sizes already.
void Simulation::keep(State& state) const {
  state.bodies.resize(world_.bodies().size());
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    const mechanics::Body& body = *world_.bodies()[i];
    state.bodies[i].resize(body.state_size());
    body.save_state(state.bodies[i]);
  }
  state.efforts = effort_;
  state.motions.resize(actuators_.size());
  state.setpoints.resize(actuators_.size());
  std::ranges::transform(actuators_, state.motions.begin(), &ActuatorState::motion);
  std::ranges::transform(actuators_, state.setpoints.begin(), &ActuatorState::wound);
  state.drives = drive_state_;
  state.loads = load_applied_;
  world_.save_frames(state.frames);
  state.controller.resize(controller_ != nullptr ? controller_->memory_size() : 0);
  if (controller_ != nullptr) controller_->save_memory(state.controller);
  state.ledger = ledger_;
  state.volume_ratio = volume_ratio_;
  state.residual = report_.relative_residual;
  state.last_step = step_before_;
  state.next_step = substep_;
  state.steps = steps_;
}

State Simulation::state() const {
  State state;
  keep(state);
  return state;
}

void Simulation::restore(const State& state) {
  check_count("bodies of the state", world_.bodies().size(), state.bodies.size());
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    check_count("numbers of a body's state", world_.bodies()[i]->state_size(),
                state.bodies[i].size());
  }
  check_count("efforts of the state", effort_.size(), state.efforts.size());
  check_count("motions of the state", actuators_.size(), state.motions.size());
  check_count("setpoints of the state", actuators_.size(), state.setpoints.size());
  check_count("numbers of the state's drives", drive_state_.size(), state.drives.size());
  check_count("load factors of the state", load_applied_.size(), state.loads.size());
  check_count("frames of the state", world_.frames_size(), state.frames.size());
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    world_.body(static_cast<int>(i)).load_state(state.bodies[i]);
  }
  effort_ = state.efforts;
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    ActuatorState& actuator = actuators_[i];
    actuator.motion = state.motions[i];
    actuator.wound = state.setpoints[i];
    actuator.effort = effort_[static_cast<std::size_t>(model_->actuators()[i].row)];
    actuator.slack = model_->actuators()[i].type == ActuatorType::cable && !(actuator.effort > 0.0);
  }
  drive_state_ = state.drives;
  for (std::size_t k = 0; k < load_applied_.size(); ++k) apply_load(k, state.loads[k]);
  world_.load_frames(state.frames);
  ledger_ = state.ledger;
  volume_ratio_ = state.volume_ratio;
  report_.relative_residual = state.residual;
  step_before_ = state.last_step;
  substep_ = state.next_step;
  steps_ = state.steps;
  if (controller_ == nullptr) return;
  if (!state.controller.empty() && state.controller.size() == controller_->memory_size()) {
    controller_->load_memory(state.controller);
  } else {
    controller_->forget();
  }
}

Inputs Simulation::inputs() const {
  Inputs inputs;
  for (const ActuatorState& actuator : actuators_) inputs.commands.push_back(actuator.command);
  inputs.loads = load_factors_;
  for (const auto& body : world_.bodies()) {
    BodyInputs& own = inputs.bodies.emplace_back();
    const fem::FemBody* fem = fem_of(body);
    if (fem != nullptr) own = {fem->external_forces(), fem->tether(), fem->rigid_base().asked()};
  }
  return inputs;
}

void Simulation::set_inputs(const Inputs& inputs) {
  check_count("commands", actuators_.size(), inputs.commands.size());
  check_count("load factors", load_factors_.size(), inputs.loads.size());
  check_count("bodies of the inputs", world_.bodies().size(), inputs.bodies.size());
  for (std::size_t i = 0; i < inputs.bodies.size(); ++i) {
    const fem::FemBody* fem = fem_of(world_.bodies()[i]);
    if (fem == nullptr) continue;
    check_count("nodes of external forces", static_cast<std::size_t>(fem->positions().rows()),
                static_cast<std::size_t>(inputs.bodies[i].external_forces.rows()));
  }
  for (std::size_t i = 0; i < actuators_.size(); ++i) actuators_[i].command = inputs.commands[i];
  load_factors_ = inputs.loads;
  for (std::size_t i = 0; i < inputs.bodies.size(); ++i) {
    fem::FemBody* fem = fem_of(world_.bodies()[i]);
    if (fem == nullptr) continue;
    fem->external_forces() = inputs.bodies[i].external_forces;
    fem->set_tether(inputs.bodies[i].tether);
    fem->rigid_base().ask(inputs.bodies[i].base);
  }
}

std::unique_ptr<Simulation> Simulation::clone() const {
  auto copy = std::make_unique<Simulation>(model_, threads());
  copy->set_inputs(inputs());
  copy->restore(state());
  return copy;
}

}  // namespace sinew::sim
