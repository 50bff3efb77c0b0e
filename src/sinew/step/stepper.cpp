#include "sinew/step/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/core/error.hpp"
#include "sinew/law/controller.hpp"
#include "sinew/run/run.hpp"
#include "sinew/step/step_verdict.hpp"
#include "sinew/step/without_controller.hpp"

namespace sinew::step {

namespace {

// A failed step is divided into parts, at most this many.
constexpr double kMaxParts = 16.0;
// After a divided step, the next one begins with parts of the same length. Each step without a
// failure lets the next one try parts longer by this factor, since steps that failed at 40 ms (a
// sole creeping over the floor) mostly fail there again.
constexpr double kLonger = 1.25;
// A command was not reached if it is missed by more than this fraction of the robot's size.
constexpr double kReached = 1e-3;
// Smaller gains of energy, relative to the sum of forces times the robot's size, are rounding, as
// for a robot at rest.
constexpr double kNoEnergy = 1e-10;
// Relative rounding of a pressure at vacuum.
constexpr double kVacuumRounding = 1e-9;
// By how many failures a controller trusts its linearisation less after a step without it.
constexpr int kTrust = 6;

}  // namespace

void Stepper::step() {
  run::StepReport& report = run_.report;
  run_.clock.start();
  run_.watch.begin();
  report.substeps = 1;
  report.retries = 0;
  report.impacts = 0;
  report.choice_held = false;
  report.status = run::StepStatus::solved;
  report.physical = true;
  report.snapped = false;
  report.energy_gained = 0.0;
  const bool opens = run_.model->step().dynamic() && !run_.ledger.is_open();
  if (opens) run_.ledger.open(run_.world.bodies().energies());
  divided_ = false;
  try {
    make_or_hold_back();
  } catch (const Error& failure) {
    if (failure.is_run_failure()) report.status = failure_status(run_);
    undo(opens);
    throw;
  } catch (...) {  // of a watcher
    undo(opens);
    throw;
  }
  ++run_.steps;
  judge();
  run_.clock.mark(world::Stage::correction);
  run_.clock.stop();
  report.times = run_.clock.times();
}

void Stepper::make() {
  divided_ = false;
  if (run_.model->step().event_driven()) return step_by_events();
  if (run_.keeps_going) return step_as_it_is();
  if (run_.model->step().adaptive) return step_adaptively();
  step_in_parts();
}

// The choices of a controller in the parts of a dynamic step may lead where no effort helps any
// more: the whole step is then made without it.
void Stepper::make_or_hold_back() {
  try {
    return make();
  } catch (const Error& failure) {
    if (run_.controller == nullptr || !failure.is_run_failure()) throw;
    undo(false);
    std::vector<double> memory(run_.controller->memory_size());
    run_.controller->save_memory(memory);
    bool solved = false;
    try {
      const WithoutController without(run_);
      solved = hold_back();
    } catch (...) {  // of a watcher
      held_.clear();
      run_.controller->load_memory(memory);
      throw;
    }
    held_.clear();
    run_.controller->load_memory(memory);
    if (!solved) throw;
    run_.controller->hold_back(kTrust);
  }
  run_.report.choice_held = true;
}

// The actuators of the controller keep the efforts of the last step or, where these cannot be
// solved either, retreat towards none. @return whether one of these steps was solved.
bool Stepper::hold_back() {
  const std::vector<model::ActuatorState> start = run_.actuation.states();
  for (const double fraction : {1.0, 0.5, 0.0}) {
    held_.clear();
    for (std::size_t i = 0; i < start.size(); ++i) {
      const model::Limits& limits = run_.model->actuators()[i].effort;
      held_.push_back(std::clamp(fraction * start[i].effort, limits.min, limits.max));
    }
    try {
      make();
      return true;
    } catch (const Error& failure) {
      if (!failure.is_run_failure()) throw;
      undo(false);
      ++run_.report.retries;
    }
  }
  return false;
}

void Stepper::undo(bool opened_ledger) {
  if (std::exchange(divided_, false)) run_.restore(start_);
  if (opened_ledger) run_.ledger.restart();
  part_.reset();
}

// Makes the whole step or, if Newton's method fails, halves of it, and halves of those: jumps of
// commands and loads are then approached gradually.
void Stepper::step_in_parts() {
  const model::StepSettings& settings = run_.model->step();
  const double whole = settings.time_step;
  // A controller would choose anew in each part, to close the whole gap: its choice is rejected for
  // the whole step instead (Substep::solve).
  const bool steered = run_.controller != nullptr;
  const bool parts = settings.method == model::Method::newton && settings.dynamic() && !steered;
  double length = parts ? first_part() : 1.0, next = kLonger * run_.next_step;
  if (length == 1.0) {
    try {
      run_.report.error = substep(static_cast<double>(run_.steps + 1) * whole, whole, parts);
      run_.next_step = 0.0;
      return;
    } catch (const Error& failure) {
      if (!parts || !failure.is_run_failure()) throw;
    }
    length = 0.5;  // the failed step is undone
    next = length * whole;
    ++run_.report.retries;
  }
  go_on_in_parts(length, next);
}

// A step that failed in all of its parts is made once as a whole: it may end anywhere.
void Stepper::step_as_it_is() {
  const double whole = run_.model->step().time_step;
  run_.report.error = substep(static_cast<double>(run_.steps + 1) * whole, whole, false);
}

// Length of the first part, as a fraction of the step: a power of two.
double Stepper::first_part() const {
  const double next = run_.next_step / run_.model->step().time_step;
  double length = 1.0;
  while (next > 0.0 && length > next && length * kMaxParts > 1.0) length *= 0.5;
  return length;
}

// @param next length that the next step tries if none of these parts fails, s.
void Stepper::go_on_in_parts(double length, double next) {
  run::StepReport& report = run_.report;
  const double begin = run_.time(), whole = run_.model->step().time_step;
  run_.keep(start_);
  divided_ = true;
  part_ = whole_step(begin);
  double done = 0.0;
  report.substeps = 0;
  while (done < 1.0) {
    try {
      part_->fraction = done + length;
      const bool divisible = length * kMaxParts > 1.0;
      report.error = substep(begin + (done + length) * whole, length * whole, divisible);
      done += length;
      ++report.substeps;
    } catch (const Error& failure) {
      length *= 0.5;
      next = length * whole;
      ++report.retries;
      if (length * kMaxParts < 1.0 || !failure.is_run_failure()) throw;
    }
  }
  run_.next_step = next;
  part_.reset();
}

void Stepper::step_by_events() {
  run_.keep(start_);
  divided_ = true;
  events_.step(run_.time(), run_.model->step().time_step);
}

// Commanded rates count from the start of the step, and rate limits refer to the whole step.
Stepper::Part Stepper::whole_step(double begin) {
  const double whole = run_.model->step().time_step;
  run_.read_commands(begin + whole, whole);
  Part part{0.0, run_.actuation.states(), {}};
  for (std::size_t i = 0; i < part.start.size(); ++i) {
    part.goal.push_back(run_.world.problem().actuators[i].value);
  }
  return part;
}

void Stepper::go_in_proportion() {
  std::vector<law::ActuatorBlock>& blocks = run_.world.problem().actuators;
  for (std::size_t i = 0; i < part_->goal.size(); ++i) {
    if (blocks[i].kind != model::CommandKind::input) blocks[i].value = part_->goal[i];
  }
  run::blend(blocks, part_->start, part_->fraction);
}

// Halves the step if it fails; otherwise aims at nine tenths of the length that the tolerance
// permits, by the order of the error, and at most twice the last length.
void Stepper::step_adaptively() {
  run::StepReport& report = run_.report;
  const model::StepSettings& settings = run_.model->step();
  const double begin = run_.time(), whole = settings.time_step;
  const double tolerance = settings.adaptive->tolerance * run_.model->size();
  const double smallest = settings.adaptive->smallest;
  const double order = mechanics::history_count(settings.integrator) > 0 ? 3.0 : 2.0;
  run_.keep(start_);
  divided_ = true;
  if (!(run_.next_step > 0.0)) run_.next_step = whole;
  report.substeps = 0;
  report.error = 0.0;
  double done = 0.0;
  while (done < whole * (1.0 - 1e-9)) {
    const double left = whole - done;
    const double h = run_.next_step < 0.999 * left ? std::min(run_.next_step, 0.5 * left) : left;
    try {
      const double error = substep(begin + done + h, h, 0.5 * h >= smallest);
      const double aim =
          error > 0.0 ? std::clamp(0.9 * std::pow(tolerance / error, 1.0 / order), 0.2, 2.0) : 2.0;
      if (error > tolerance && 0.5 * h >= smallest) {
        run_.restore(run_.before);
        run_.next_step = std::max(smallest, std::min(0.5, aim) * h);
        ++report.retries;
        continue;
      }
      done += h;
      ++report.substeps;
      report.error = std::max(report.error, error);
      run_.next_step = std::min(whole, std::max(smallest, aim * h));
    } catch (const Error& failure) {
      if (0.5 * h < smallest || !failure.is_run_failure()) throw;
      run_.next_step = 0.5 * h;
      ++report.retries;
    }
  }
}

// Solves the step's equation once. @return the error estimate, m.
double Stepper::substep(double end, double time_step, bool divisible) {
  substep_.read_commands(end, time_step);
  if (part_) go_in_proportion();
  for (std::size_t i = 0; i < held_.size(); ++i) {
    if (!run_.actuation.states()[i].chosen) continue;
    run_.world.problem().actuators[i].hold_effort(held_[i]);
  }
  substep_.begin(time_step);
  substep_.solve(time_step, divisible);
  return substep_.end(time_step);
}

// Whether a chamber needs an absolute pressure below zero: a commanded volume, or a liquid of which
// some was taken out, holds at any pressure, but no fluid pulls.
bool Stepper::cavitates() const {
  const auto& models = run_.model->actuators();
  for (std::size_t i = 0; i < models.size(); ++i) {
    const double least = (1.0 + kVacuumRounding) * models[i].vacuum.value_or(-kInfinity);
    if (run_.actuation.states()[i].effort < least) return true;
  }
  return false;
}

// Determines the status of the step.
void Stepper::judge() {
  run::StepReport& report = run_.report;
  const auto raise = [&](run::StepStatus status) {
    report.status = std::max(report.status, status);
  };
  if (report.law == run::LawStatus::limits_conflict) raise(run::StepStatus::limits_conflict);
  if (cavitates()) raise(run::StepStatus::cavitates);
  if (report.scale < 1.0) raise(run::StepStatus::cut_back);
  if (report.violation > kReached * run_.model->size()) raise(run::StepStatus::command_not_reached);
  report.balanced = !run_.keeps_going && is_balanced(run_) &&
                    (run_.model->step().dynamic() || reactions_balance(run_));
  if (!report.balanced) raise(failure_status(run_));
  if (run_.failed) raise(run::StepStatus::after_failure);
  if (run_.model->step().dynamic()) watch_energy();
  run_.failed = run_.failed || is_failure(report.status);
}

void Stepper::watch_energy() {
  const world::Bodies& bodies = run_.world.bodies();
  run_.report.energy_gained = run_.ledger.gained(run_.world.bodies().energies());
  const double nothing = kNoEnergy * bodies.force_scale() * run_.model->size();
  if (run_.ledger.is_excessive(run_.report.energy_gained, nothing)) {
    run_.report.status = std::max(run_.report.status, run::StepStatus::gaining_energy);
  }
}

}  // namespace sinew::step
