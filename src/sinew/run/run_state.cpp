// State and inputs of a Run as values.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/law/controller.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/run/inputs.hpp"
#include "sinew/run/run.hpp"
#include "sinew/world/end_efforts.hpp"

namespace sinew::run {

namespace {

void check_count(const char* what, std::size_t expected, std::size_t got) {
  if (expected == got) return;
  throw Error(ErrorKind::wrong_length, {.item = what},
              fmt::format("{} are given, this robot has {}", got, expected),
              "take them from a simulation of the same model");
}

void check_state(const Run& run, const State& state) {
  const auto bodies = run.world.bodies().all();
  check_count("bodies of the state", bodies.size(), state.bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    check_count("numbers of a body's state", bodies[i]->state_size(), state.bodies[i].size());
  }
  const Actuation& actuation = run.actuation;
  check_count("efforts of the state", run.effort.size(), state.efforts.size());
  check_count("motions of the state", actuation.states().size(), state.motions.size());
  check_count("setpoints of the state", actuation.states().size(), state.setpoints.size());
  check_count("numbers of the state's drives", actuation.drive_numbers(), state.drives.size());
  check_count("load factors of the state", run.surroundings.applied().size(), state.loads.size());
  check_count("frames of the state", run.world.contacts().planes().frames_size(),
              state.frames.size());
  if (!state.afresh.empty()) {
    check_count("restarts of the state", bodies.size(), state.afresh.size());
  }
  const std::size_t coordinates = run.world.bodies().size();
  if (!world::EndEfforts::is_size(state.end_efforts.size(), run.effort.size(), coordinates)) {
    check_count("efforts at the end of the state's step", 1 + 2 * run.effort.size() + coordinates,
                state.end_efforts.size());
  }
  check_count("joints of the state", run.world.joints().values().size(), state.joints.size());
}

void check_stiffness_factor(const mechanics::Body& body, double factor) {
  if (factor > 0.0 && std::isfinite(factor)) return;
  throw Error(ErrorKind::out_of_range,
              {.item = fmt::format("body('{}').stiffness_factor", body.model().name())},
              fmt::format("it is {:g}", factor), "give a positive number");
}

}  // namespace

void Run::keep(State& state) const {
  const auto bodies = world.bodies().all();
  state.bodies.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    state.bodies[i].resize(bodies[i]->state_size());
    bodies[i]->save_state(state.bodies[i]);
  }
  state.efforts = effort;
  actuation.save(state);
  state.loads = surroundings.applied();
  world.contacts().planes().save_frames(state.frames);
  world.contacts().planes().save_points(state.points);
  state.joints = world.joints().values();
  const law::WithMemory* remembering = attached();
  state.controller.resize(remembering != nullptr ? remembering->memory_size() : 0);
  if (remembering != nullptr) remembering->save_memory(state.controller);
  state.ledger = ledger.sums();
  state.volume_ratio = volume_ratio;
  state.failed = failed ? 1.0 : 0.0;
  state.residual = report.relative_residual;
  state.last_step = last_step;
  const std::vector<char>& afresh = world.bodies().afresh();
  state.afresh.clear();
  if (world.bodies().any_afresh()) state.afresh.assign(afresh.begin(), afresh.end());
  correction.save(state.correction);
  kept_factors.save(state.kept_factors);
  world.end_efforts().save(state.end_efforts);
  state.next_step = next_step;
  state.steps = steps;
}

void Run::restore(const State& state) {
  check_state(*this, state);
  world.forget_solved();
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    world.bodies().all()[i]->load_state(state.bodies[i]);
  }
  effort = state.efforts;
  actuation.load(state);
  for (std::size_t k = 0; k < state.loads.size(); ++k) surroundings.apply(k, state.loads[k]);
  world.contacts().planes().load_frames(state.frames);
  world.contacts().planes().load_points(state.points);
  world.joints().values() = state.joints;
  ledger.set(state.ledger);
  volume_ratio = state.volume_ratio;
  failed = state.failed != 0.0;
  report.relative_residual = state.residual;
  last_step = state.last_step;
  std::vector<char>& afresh = world.bodies().afresh();
  std::ranges::fill(afresh, 0);
  std::ranges::transform(state.afresh, afresh.begin(), [](double on) { return on != 0.0; });
  correction = MeasuredCorrection(state.correction);
  kept_factors = KeptFactors(state.kept_factors);
  world.end_efforts().load(state.end_efforts, effort.size(), world.bodies().size());
  next_step = state.next_step;
  steps = state.steps;
  law::WithMemory* remembering = attached();
  if (remembering == nullptr) return;
  if (!state.controller.empty() && state.controller.size() == remembering->memory_size()) {
    remembering->load_memory(state.controller);
  } else {
    remembering->forget();
  }
}

void Run::go_back() {
  restore(before);
  world.homotopy().set_fraction(0.0);
}

Inputs Run::inputs() const {
  Inputs inputs;
  for (const model::ActuatorState& actuator : actuation.states()) {
    inputs.commands.push_back(actuator.command);
  }
  inputs.loads = surroundings.factors();
  inputs.follows = follows;
  for (const auto& body : world.bodies().all()) {
    BodyInputs& own = inputs.bodies.emplace_back();
    if (const auto* pulled = mechanics::as<mechanics::TakesForces>(*body)) {
      own.external_forces = pulled->external_forces();
      own.tether = pulled->tether();
    }
    if (const auto* standing = mechanics::as<mechanics::HasBase>(*body)) {
      own.base = standing->base_input();
    }
    if (const auto* made = mechanics::as<mechanics::ScalesStiffness>(*body)) {
      own.stiffness_factor = made->stiffness_factor();
    }
  }
  return inputs;
}

void Run::set_inputs(const Inputs& inputs) {
  const auto bodies = world.bodies().all();
  check_count("commands", actuation.states().size(), inputs.commands.size());
  check_count("load factors", surroundings.factors().size(), inputs.loads.size());
  check_count("bodies of the inputs", bodies.size(), inputs.bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (mechanics::as<mechanics::ScalesStiffness>(*bodies[i]) != nullptr) {
      check_stiffness_factor(*bodies[i], inputs.bodies[i].stiffness_factor);
    }
    if (mechanics::as<mechanics::TakesForces>(*bodies[i]) == nullptr) continue;
    check_count("nodes of external forces", static_cast<std::size_t>(bodies[i]->positions().rows()),
                static_cast<std::size_t>(inputs.bodies[i].external_forces.rows()));
  }
  actuation.set_commands(inputs.commands);
  surroundings.set_factors(inputs.loads);
  follows = inputs.follows;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodyInputs& own = inputs.bodies[i];
    if (auto* pulled = mechanics::as<mechanics::TakesForces>(*bodies[i])) {
      pulled->external_forces() = own.external_forces;
      pulled->set_tether(own.tether);
    }
    if (auto* standing = mechanics::as<mechanics::HasBase>(*bodies[i])) {
      standing->move_base(own.base);
    }
    if (auto* made = mechanics::as<mechanics::ScalesStiffness>(*bodies[i])) {
      made->set_stiffness_factor(own.stiffness_factor);
    }
  }
}

// The factor scales the stresses at the present strain, so the strain energy jumps by what this
// change puts in.
void Run::set_stiffness_factor(int body, double factor) {
  mechanics::Body& own = *world.bodies().all()[static_cast<std::size_t>(body)];
  auto* made = mechanics::as<mechanics::ScalesStiffness>(own);
  if (made == nullptr) {
    throw Error(ErrorKind::wrong_type, {.item = own.model().name()},
                "this body has no stiffness factor", "name a finite-element body");
  }
  check_stiffness_factor(own, factor);
  if (factor == made->stiffness_factor()) return;
  const double strain = own.energies().strain;
  made->set_stiffness_factor(factor);
  ledger.count_outside(own.energies().strain - strain);
}

}  // namespace sinew::run
