#include "sinew/run/run.hpp"

#include <algorithm>
#include <utility>

#include "sinew/law/controller.hpp"
#include "sinew/run/commander.hpp"
#include "sinew/run/newton.hpp"
#include "sinew/world/end_efforts.hpp"

namespace sinew::run {

namespace {

constexpr double kUsableContacts = 1e-7;  // see qp::ConeSettings::usable

}  // namespace

Run::Run(std::shared_ptr<const model::Model> shared_model, int threads)
    : model(std::move(shared_model)),
      pool(threads),
      world(model, pool),
      solver(qp::ConeSettings{.tolerance = model->step().contact_tolerance,
                              .usable = kUsableContacts,
                              .poll = &watch.poll()}),
      correction_solver(qp::ConeSettings{.tolerance = model->step().contact_tolerance,
                                         .usable = kUsableContacts,
                                         .poll = &watch.poll()}),
      actuation(*model),
      surroundings(*model, world.bodies()),
      effort(static_cast<std::size_t>(model->rows().rows()), 0.0),
      instruments(*this) {
  finish_step();
  instruments.begin();
  keep(before);
}

mechanics::StepWeights Run::step_weights(double time_step) const {
  const model::StepSettings& settings = model->step();
  return mechanics::step_weights(settings.integrator, time_step, last_step,
                                 settings.spectral_radius);
}

Quadrature Run::quadrature() const {
  const bool back = reaches_back() && !world.bodies().any_afresh();
  return back || !model->step().dynamic() ? Quadrature::trapezoid : Quadrature::one_force;
}

mechanics::LinearisationRequest Run::request(double time_step) const {
  return {step_weights(time_step),
          model->step().tangent,
          model->geometric_stiffness().extends_pattern,
          true,
          true,
          weights_afresh(time_step)};
}

std::optional<mechanics::StepWeights> Run::weights_afresh(double time_step) const {
  if (last_step == 0.0 || !world.bodies().any_afresh()) return {};
  return mechanics::step_weights(model->step().integrator, time_step);
}

void Run::forget_history() {
  last_step = 0.0;
  world.end_efforts().clear();
  std::ranges::fill(world.bodies().afresh(), 0);
}

bool Run::reaches_back() const {
  return mechanics::history_count(model->step().integrator) > 0 && last_step > 0.0;
}

void Run::read_commands(double time, double time_step) {
  law::StepProblem& problem = world.problem();
  problem.time = time;
  problem.time_step = time_step;
  actuation.form_blocks(time, time_step, problem.actuators);
  world.hold_friction();
}

void Run::begin_world(double time_step) {
  surroundings.move_bases(now);
  surroundings.apply(now);
  clock.mark(world::Stage::assembly);
  using enum mechanics::RollingPoint::Turning;
  const bool second_order = reaches_back() || world.rows().halved;
  world.contacts().planes().let_normals_turn(!model->step().dynamic() ? fixed
                                             : second_order           ? end
                                                                      : mean);
  world.begin_step(now - time_step, now, effort);
  clock.mark(world::Stage::detection);
}

NewtonReport Run::newton(law::Controller* chooser, const NewtonSettings& settings) {
  return solve_newton(world, solver, chooser, effort, settings, clock, watch);
}

law::WithMemory* Run::attached() const {
  if (controller != nullptr) return controller;
  return commander;
}

model::Equilibrium Run::equilibrium() const {
  const bool steered = follows || attached() != nullptr;
  return model->step().equilibrium.value_or(steered ? model::Equilibrium::following
                                                    : model::Equilibrium::converged);
}

void Run::finish_step() {
  actuation.read(world.measure_delta(), effort, world.problem().actuators);
  world.joints().accept(world.delta());
}

void Run::restart() {
  actuation.restart();
  surroundings.restart();
  world.restart();
  std::ranges::fill(effort, 0.0);
  std::ranges::fill(world.problem().actuators, law::ActuatorBlock{});
  volume_ratio = 1.0;
  failed = false;
  ledger = {};
  last_step = next_step = 0.0;
  correction = {};
  kept_factors = {};
  world.end_efforts().clear();
  steps = 0;
  finish_step();
  if (law::WithMemory* one = attached()) one->forget();
  report = {};
  instruments.begin();
}

std::size_t Run::bytes() const {
  return world.bytes() + sizeof(double) * (effort.size() + before.size()) +
         actuation.states().size() * (sizeof(model::ActuatorState) + sizeof(law::ActuatorBlock));
}

}  // namespace sinew::run
