#include "sinew/sim/simulation.hpp"

#include <utility>

#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/held_rows.hpp"
#include "sinew/run/commander.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/inputs.hpp"
#include "sinew/run/run.hpp"
#include "sinew/statics/path_follower.hpp"
#include "sinew/statics/static_solver.hpp"
#include "sinew/step/stepper.hpp"

namespace sinew::sim {

Simulation::Simulation(std::shared_ptr<const model::Model> model, int threads)
    : run_(std::make_unique<run::Run>(std::move(model), threads)),
      stepper_(std::make_unique<step::Stepper>(*run_)) {}

Simulation::~Simulation() = default;

const model::Model& Simulation::model() const { return *run_->model; }
std::shared_ptr<const model::Model> Simulation::shared_model() const { return run_->model; }
int Simulation::threads() const { return run_->pool.size(); }
long Simulation::work_done(int thread) const { return run_->pool.parts_done(thread); }
double Simulation::time() const { return run_->time(); }
std::int64_t Simulation::steps() const { return run_->steps; }

const run::StepReport& Simulation::step(OnFailure on_failure) {
  try {
    make_step();
  } catch (const Error& failure) {
    if (on_failure != OnFailure::keep_going || !failure.is_run_failure()) throw;
    keep_failed_step();
  }
  run_->instruments.advance();
  return run_->report;
}

// Makes a step again that failed although everything was tried, and keeps where it ends.
void Simulation::keep_failed_step() {
  run_->keeps_going = true;
  try {
    make_step();
  } catch (...) {
    run_->keeps_going = false;
    throw;
  }
  run_->keeps_going = false;
}

void Simulation::make_step() {
  if (run_->commander != nullptr) return step_by_command();
  stepper_->step();
}

// If no step can be made with the commands of the commander, its last ones are kept; if that fails,
// too, the first error is reported. A failed step restores the commander.
void Simulation::step_by_command() {
  run::Commander& commander = *run_->commander;
  std::vector<double> memory(commander.memory_size());
  commander.save_memory(memory);
  try {
    commander.command();
    stepper_->step();
  } catch (const Error& failure) {
    commander.load_memory(memory);
    if (!failure.is_run_failure() || !make_same_step()) throw;
    commander.hold_back();
  } catch (...) {
    commander.load_memory(memory);
    throw;
  }
}

bool Simulation::make_same_step() {
  try {
    stepper_->step();
  } catch (const Error& failure) {
    if (!failure.is_run_failure()) throw;
    return false;
  }
  ++run_->report.retries;
  run_->report.choice_held = true;
  return true;
}

const run::StepReport& Simulation::report() const { return run_->report; }
void Simulation::watch(run::StepWatcher watcher) { run_->watch.set_watcher(std::move(watcher)); }
mechanics::Energies Simulation::energies() { return run_->world.bodies().energies(); }
const run::EnergyLedger& Simulation::ledger() const { return run_->ledger.sums(); }

statics::StaticReport Simulation::solve_static(const statics::StaticSettings& settings) {
  statics::StaticReport report = statics::StaticSolver(*run_, settings).run();
  run_->instruments.settle(run::Rest::found);
  return report;
}

statics::Path Simulation::follow_path(const statics::PathSettings& settings,
                                      const std::function<void()>& visit) {
  statics::Path path = statics::PathFollower(*run_, settings).follow([&] {
    run_->instruments.settle(run::Rest::on_path);
    if (visit) visit();
  });
  run_->instruments.settle(run::Rest::end_of_path);
  return path;
}

void Simulation::reset() { run_->restart(); }

void Simulation::follow(bool on) { run_->follows = on; }
bool Simulation::follows() const { return run_->follows; }
model::Equilibrium Simulation::equilibrium() const { return run_->equilibrium(); }

void Simulation::command(int actuator, model::Command command, const run::Commander* by) {
  run_->actuation.command(actuator, std::move(command), by);
}

const model::ActuatorState& Simulation::actuator(int index) const {
  return run_->actuation.states()[static_cast<std::size_t>(index)];
}

void Simulation::move_base(int body, const Vector3& translation, const Vector3& rotation,
                           const Vector3& centre) {
  run_->surroundings.move_base(body, translation, rotation, centre);
}

void Simulation::set_load(int load, model::Signal factor) {
  run_->surroundings.set_factor(load, std::move(factor));
}

void Simulation::set_stiffness_factor(int body, double factor) {
  run_->set_stiffness_factor(body, factor);
}

const model::Signal& Simulation::load_factor(int load) const {
  return run_->surroundings.factors()[static_cast<std::size_t>(load)];
}

Vector3 Simulation::effector_value(int index) const {
  return model().effector(index).value(configuration());
}

std::vector<double> Simulation::probe_values(int index) const {
  const constraint::Probe& probe = model().probe(index);
  std::vector<double> values(probe.components().size());
  probe.measure(configuration(), values);
  return values;
}

run::Instruments& Simulation::instruments() { return run_->instruments; }
const run::Instruments& Simulation::instruments() const { return run_->instruments; }

run::ContactReader Simulation::contacts() const { return run::ContactReader(*run_); }

void Simulation::require_free(const law::WithMemory* newcomer) const {
  const law::WithMemory* present = run_->attached();
  if (present == nullptr || present == newcomer) return;
  throw Error(ErrorKind::actuator_owned, {.item = "controller"},
              "another controller is attached to this simulation", "detach it first");
}

void Simulation::attach(law::Controller& controller, std::span<const int> actuators,
                        std::span<const int> contacts) {
  if (model().step().event_driven()) {
    throw Error(ErrorKind::not_in_this_version, {.item = "controller"},
                "event-driven integration makes parts of a step several times, which a controller "
                "would take for steps",
                "choose backward-euler or bdf2 for a robot with a controller");
  }
  require_free(&controller);
  model::check_held_radius(model().step(), "a controller holds");
  run_->controller = &controller;
  run_->actuation.own(&controller, actuators);
  run_->world.contacts().require_active(contacts);
}

void Simulation::detach(const law::Controller& controller) {
  if (run_->controller != &controller) return;
  run_->controller = nullptr;
  run_->actuation.release(&controller);
  run_->world.contacts().require_active({});
}

void Simulation::attach(run::Commander& commander, std::span<const int> actuators) {
  require_free(&commander);
  run_->commander = &commander;
  run_->actuation.own(&commander, actuators, false);
}

void Simulation::detach(const run::Commander& commander) {
  if (run_->commander != &commander) return;
  run_->commander = nullptr;
  run_->actuation.release(&commander);
}

world::World& Simulation::world() { return run_->world; }
const world::World& Simulation::world() const { return run_->world; }
int Simulation::bodies() const { return static_cast<int>(run_->world.bodies().all().size()); }

mechanics::Body& Simulation::body(int index) {
  return *run_->world.bodies().all()[static_cast<std::size_t>(index)];
}

const mechanics::Body& Simulation::body(int index) const {
  return *run_->world.bodies().all()[static_cast<std::size_t>(index)];
}

const constraint::Configuration& Simulation::configuration() const {
  return run_->world.configuration();
}
std::span<const double> Simulation::efforts() const { return run_->effort; }

std::span<const double> Simulation::drive_state(int actuator) const {
  return run_->actuation.drive_state(actuator);
}

std::span<const law::ActuatorBlock> Simulation::actuator_blocks() const {
  return std::span(run_->world.problem().actuators).first(model().actuators().size());
}

run::State Simulation::state() const {
  run::State state;
  run_->keep(state);
  run_->instruments.save(state.instruments);
  return state;
}

void Simulation::restore(const run::State& state) {
  run_->restore(state);
  run_->world.contacts().forget_friction();
  run_->instruments.load(state.instruments);
}
run::Inputs Simulation::inputs() const { return run_->inputs(); }
void Simulation::set_inputs(const run::Inputs& inputs) { run_->set_inputs(inputs); }

std::unique_ptr<Simulation> Simulation::clone() const {
  auto copy = std::make_unique<Simulation>(run_->model, threads());
  copy->set_inputs(inputs());
  copy->restore(state());
  return copy;
}

std::size_t Simulation::bytes() const { return run_->bytes() + stepper_->bytes(); }

}  // namespace sinew::sim
