#include "sinew/sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/state_hash.hpp"
#include "sinew/fem/fem_body.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/step/step_solver.hpp"

namespace sinew::sim {

namespace {

// A step that fails is made in parts, the smallest of which is the inverse of this.
constexpr double kMostParts = 16.0;

}  // namespace

Simulation::Simulation(std::shared_ptr<const Model> model, int threads)
    : model_(std::move(model)),
      pool_(std::make_unique<ThreadPool>(threads)),
      world_(model_, *pool_),
      solver_(std::make_unique<step::StepSolver>(
          qp::ConeSettings{.tolerance = model_->step().contact_tolerance})),
      actuators_(model_->actuators().size()),
      effort_(static_cast<std::size_t>(model_->rows().rows()), 0.0),
      drive_state_(static_cast<std::size_t>(model_->drive_states()), 0.0) {
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    actuators_[i].command = model_->actuators()[i].command;
    if (const auto& drive = model_->actuators()[i].drive) drive->rest(drive_numbers(i));
  }
  finish_step();
  motion_before_.resize(actuators_.size());
  for (const LoadModel& load : model_->loads()) load_factors_.push_back(load.factor);
  load_applied_.resize(load_factors_.size());
  keep(state_before_);
}

Simulation::~Simulation() = default;

void Simulation::read_commands(double time, double time_step) {
  step::StepProblem& problem = world_.problem();
  problem.time = time;
  problem.time_step = time_step;
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    step::ActuatorBlock& block = problem.actuators[i];
    block =
        actuator_block(model_->actuators()[i], actuators_[i], drive_numbers(i), time, time_step);
    if (part_) blend(block, part_->start[i], part_->fraction);
  }
  if (!model_->guides().empty()) world_.hold_capstans(world_.measure_delta());
}

std::span<const double> Simulation::drive_state(int actuator) const {
  const ActuatorModel& model = model_->actuators()[static_cast<std::size_t>(actuator)];
  if (model.drive == nullptr) return {};
  return std::span(drive_state_)
      .subspan(static_cast<std::size_t>(model.first_state),
               static_cast<std::size_t>(model.drive->state_size()));
}

std::span<double> Simulation::drive_numbers(std::size_t actuator) {
  return std::span(drive_state_)
      .subspan(static_cast<std::size_t>(model_->actuators()[actuator].first_state),
               drive_state(static_cast<int>(actuator)).size());
}

// After finish_step(): where each drive stands, whoever chose its effort.
void Simulation::advance_drives() {
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    const ActuatorModel& model = model_->actuators()[i];
    if (model.drive == nullptr) continue;
    Drive::Step step = world_.problem().actuators[i].drive_step;
    std::ranges::copy(drive_numbers(i), step.state.begin());
    model.drive->advance(step, actuators_[i].motion, actuators_[i].effort, drive_numbers(i));
  }
}

mechanics::StepWeights Simulation::step_weights(double time_step) const {
  const StepSettings& settings = model_->step();
  return mechanics::step_weights(settings.integrator, time_step, step_before_,
                                 settings.spectral_radius);
}

const StepReport& Simulation::step() {
  clock_.start();
  report_.substeps = 1;
  report_.retries = 0;
  report_.status = StepStatus::solved;
  report_.energy_gained = 0.0;
  if (model_->step().dynamic()) open_ledger();
  if (model_->step().adaptive) {
    step_adaptively();
  } else {
    step_in_parts();
  }
  ++steps_;
  watch();
  clock_.mark(Stage::correction);
  clock_.stop();
  report_.times = times_;
  return report_;
}

// The whole step, or, where Newton finds no end, halves of it and of those: commands that jump and
// loads that come at once are then approached.
void Simulation::step_in_parts() {
  const double whole = model_->step().time_step;
  try {
    report_.error = substep(static_cast<double>(steps_ + 1) * whole, whole);
    return;
  } catch (const Error& failure) {
    const bool parts = model_->step().method == Method::newton && model_->step().dynamic();
    if (!parts || !failure.is_run_failure()) throw;
  }
  const double begin = time();  // what failed is undone
  state_at_step_ = state_before_;
  part_ = Part{0.0, actuators_};
  double done = 0.0, length = 0.5;
  report_.substeps = 0;
  while (done < 1.0) {
    try {
      part_->fraction = done + length;
      report_.error = substep(begin + (done + length) * whole, length * whole);
      done += length;
      ++report_.substeps;
    } catch (const Error& failure) {
      length *= 0.5;
      ++report_.retries;
      if (length * kMostParts >= 1.0 && failure.is_run_failure()) continue;
      part_.reset();
      restore(state_at_step_);
      throw;
    }
  }
  part_.reset();
}

// Halves where a substep fails; else aims at nine tenths of the step that the tolerance allows, by
// the order of the error, at most twice the last one.
void Simulation::step_adaptively() {
  const StepSettings& settings = model_->step();
  const double begin = time(), whole = settings.time_step;
  const double tolerance = settings.adaptive->tolerance * model_->size();
  const double order = mechanics::history_count(settings.integrator) > 0 ? 3.0 : 2.0;
  if (!(substep_ > 0.0)) substep_ = whole;
  keep(state_at_step_);
  report_.substeps = 0;
  report_.error = 0.0;
  double done = 0.0;
  while (done < whole * (1.0 - 1e-9)) {
    const double left = whole - done;
    const double h = substep_ < 0.999 * left ? std::min(substep_, 0.5 * left) : left;
    try {
      const double error = substep(begin + done + h, h);
      const double aim =
          error > 0.0 ? std::clamp(0.9 * std::pow(tolerance / error, 1.0 / order), 0.2, 2.0) : 2.0;
      if (error > tolerance && 0.5 * h >= settings.adaptive->smallest) {
        restore(state_before_);
        substep_ = std::max(settings.adaptive->smallest, std::min(0.5, aim) * h);
        ++report_.retries;
        continue;
      }
      done += h;
      ++report_.substeps;
      report_.error = std::max(report_.error, error);
      substep_ = std::min(whole, std::max(settings.adaptive->smallest, aim * h));
    } catch (const Error& failure) {
      if (0.5 * h < settings.adaptive->smallest || !failure.is_run_failure()) {
        restore(state_at_step_);
        throw;
      }
      substep_ = 0.5 * h;
      ++report_.retries;
    }
  }
}

void Simulation::move_bases(double time) {
  for (const BaseMotion& motion : model_->base_motions()) {
    fem_body(motion.body)
        .rigid_base()
        .ask(fem::rigid_displacement(motion.translation_at(time), motion.rotation_at(time),
                                     motion.centre));
  }
}

void Simulation::move_base(int body, const Vector3& translation, const Vector3& rotation,
                           const Vector3& centre) {
  fem::FemBody& moved = fem_body(body);
  const Place place{.item = fmt::format("base of body '{}'", moved.model().name())};
  if (std::ranges::any_of(model_->base_motions(),
                          [&](const BaseMotion& motion) { return motion.body == body; })) {
    throw Error(ErrorKind::bad_argument, place, "the scene moves this base",
                "leave `base` out of the scene to move it from a script, or write the motion there "
                "as signals");
  }
  if (moved.fem_model().settings().elements.fixed_nodes.empty()) {
    throw Error(ErrorKind::nothing_fixed, place, "the body has no fixed node to move",
                "fix the region that moves");
  }
  moved.rigid_base().ask(fem::rigid_displacement(translation, rotation, centre));
}

void Simulation::set_loads(double time) {
  for (std::size_t k = 0; k < load_factors_.size(); ++k) {
    apply_load(k, load_factors_[k].value(time));
  }
}

void Simulation::apply_load(std::size_t load, double factor) {
  load_applied_[load] = factor;
  const LoadModel& model = model_->loads()[load];
  for (const int number : model.numbers) {
    fem_body(model.body).load_factors()[static_cast<std::size_t>(number)] = factor;
  }
}

void Simulation::set_load(int load, Signal factor) {
  load_factors_.at(static_cast<std::size_t>(load)) = std::move(factor);
}

// After finish_step().
void Simulation::count_work() {
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    ledger_.actuators += actuators_[i].effort * (actuators_[i].motion - motion_before_[i]);
  }
  for (const auto& body : world_.bodies()) {
    const mechanics::StepWork work = body->step_work();
    ledger_.outside += work.outside;
    ledger_.dissipated += work.damped;
  }
  for (const step::CapstanBlock& block : world_.problem().capstans) {
    const double slid = world_.delta()[block.row] - block.held;
    ledger_.dissipated -= effort_[static_cast<std::size_t>(block.row)] * slid;
  }
  count_contact_work();
}

// One solution of the step's equation; the error estimate, m.
double Simulation::substep(double end, double time_step) {
  now_ = end;
  read_commands(end, time_step);
  keep(state_before_);
  move_bases(end);
  set_loads(end);
  world_.begin_step(end - time_step, end, effort_);
  solver_->begin_step();
  if (controller_ != nullptr) controller_->begin_step();
  solve_equation(time_step);
  if (!model_->contacts().empty()) {
    report_.contact_residual = contact_result().residual;
    report_.contact_sweeps = contact_result().sweeps;
  }
  const double error = world_.end_step(step_weights(time_step));
  // A gap that closes stops its point at once. A multistep formula that reaches back over such a
  // jump would have the point rebound, and gain energy: it starts afresh behind it.
  step_before_ = world_.gap_closed(effort_) ? 0.0 : time_step;
  std::ranges::transform(actuators_, motion_before_.begin(), &ActuatorState::motion);
  finish_step();
  advance_drives();
  count_work();
  return error;
}

void Simulation::fail(ErrorKind kind, const std::string& message, const std::string& remedy) {
  restore(state_before_);
  std::string bodies;
  for (const auto& body : model_->bodies()) bodies += (bodies.empty() ? "" : ", ") + body->name();
  throw Error(kind,
              {.item = fmt::format("step {} (t = {:g} s), body {}", steps_ + 1, now_, bodies)},
              message, remedy);
}

// What actuators did, read off the state.
void Simulation::finish_step() {
  const VectorX& delta = world_.measure_delta();
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    ActuatorState& state = actuators_[i];
    const step::ActuatorBlock& block = world_.problem().actuators[i];
    const int row = model_->actuators()[i].row;
    state.effort = effort_[static_cast<std::size_t>(row)];
    state.motion = delta[row];
    state.slack = model_->actuators()[i].type == ActuatorType::cable && !(state.effort > 0.0);
    const bool winds = !block.owned && block.kind == CommandKind::motion && block.row >= 0;
    state.wound = winds ? block.value : state.motion;
  }
}

Energies Simulation::energies() {
  Energies sum;
  for (const auto& body : world_.bodies()) {
    sum.strain += body->strain_energy();
    sum.kinetic += body->kinetic_energy();
    sum.gravity += body->gravity_energy();
  }
  return sum;
}

Vector3 Simulation::effector_value(int index) const {
  return model_->effector(index).value(world_.placement());
}

std::vector<double> Simulation::probe_values(int index) const {
  const constraint::Probe& probe = *model_->probes().at(static_cast<std::size_t>(index));
  std::vector<double> values(probe.components().size());
  probe.measure(world_.placement(), values);
  return values;
}

void Simulation::command(int actuator, Command command) {
  ActuatorState& state = actuators_.at(static_cast<std::size_t>(actuator));
  if (state.owner != nullptr) {
    throw Error(ErrorKind::actuator_owned,
                {.item = model_->actuators()[static_cast<std::size_t>(actuator)].name},
                "a controller owns this actuator", "detach the controller first");
  }
  state.command = std::move(command);
}

void Simulation::attach(step::Controller& controller, std::span<const int> actuators) {
  if (controller_ != nullptr && controller_ != &controller) {
    throw Error(ErrorKind::actuator_owned, {.item = "controller"},
                "another controller is attached to this simulation", "detach it first");
  }
  controller_ = &controller;
  for (const int index : actuators) {
    actuators_.at(static_cast<std::size_t>(index)).owner = &controller;
  }
}

void Simulation::detach(const step::Controller& controller) {
  if (controller_ != &controller) return;
  controller_ = nullptr;
  for (ActuatorState& state : actuators_) {
    if (state.owner != &controller) continue;
    state.owner = nullptr;
    // The drive stays where it stands until it is told otherwise: a winch by its length, a
    // regulator by its pressure.
    const auto i = static_cast<std::size_t>(&state - actuators_.data());
    const bool regulator = model_->actuators()[i].type == ActuatorType::pressure;
    state.command = regulator ? Command{CommandKind::effort, Signal::constant(state.effort)}
                              : Command{CommandKind::motion, Signal::constant(state.motion)};
  }
}

fem::FemBody& Simulation::fem_body(int index) {
  return const_cast<fem::FemBody&>(std::as_const(*this).fem_body(index));
}

const fem::FemBody& Simulation::fem_body(int index) const {
  const auto* body = dynamic_cast<const fem::FemBody*>(&world_.body(index));
  if (body == nullptr) {
    throw Error(ErrorKind::wrong_type, {.item = world_.body(index).model().name()},
                "this body is not of finite elements", "ask for its own coordinates");
  }
  return *body;
}

std::size_t Simulation::bytes() const {
  return world_.bytes() +
         sizeof(double) * (effort_.size() + state_before_.size() + state_at_step_.size()) +
         actuators_.size() * (sizeof(ActuatorState) + sizeof(step::ActuatorBlock));
}

void Simulation::reset() {
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (actuators_[i].owner == nullptr) actuators_[i].command = model_->actuators()[i].command;
  }
  for (std::size_t k = 0; k < load_factors_.size(); ++k) {
    load_factors_[k] = model_->loads()[k].factor;
    load_applied_[k] = 0.0;
  }
  world_.restart();
  std::ranges::fill(effort_, 0.0);
  std::ranges::fill(world_.problem().actuators, step::ActuatorBlock{});
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (const auto& drive = model_->actuators()[i].drive) drive->rest(drive_numbers(i));
  }
  volume_ratio_ = 1.0;
  ledger_ = {};
  step_before_ = substep_ = 0.0;
  steps_ = 0;
  finish_step();
  if (controller_ != nullptr) controller_->forget();
  report_ = {};
}

}  // namespace sinew::sim
