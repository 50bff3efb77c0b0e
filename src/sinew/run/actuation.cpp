#include "sinew/run/actuation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/model/held_rows.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"

namespace sinew::run {

namespace {

// Start of a commanded velocity's increment: the present motion if the motor is at its effort
// limit, since it does not catch up; otherwise the last setpoint, so rounding does not accumulate.
double setpoint(const model::ActuatorModel& model, const model::ActuatorState& state) {
  const bool free = model.effort.min < state.effort && state.effort < model.effort.max;
  return free ? state.setpoint : state.motion;
}

// The block of an actuator, from its state and that of its drive at the start of the step.
law::ActuatorBlock actuator_block(const model::ActuatorModel& model,
                                  const model::ActuatorState& state,
                                  std::span<const double> drive_state, double time,
                                  double time_step) {
  const model::CommandKind chosen = state.chosen ? model::CommandKind::effort : state.command.kind;
  const Interval effort = reachable(model.effort_limits(chosen), state.effort, time_step);
  const Interval motion = reachable(model.motion, state.setpoint, time_step);
  law::ActuatorBlock block;
  block.row = model.row;
  block.effort_min = effort.min;
  block.effort_max = effort.max;
  block.motion_min = motion.min;
  block.motion_max = motion.max;
  block.kind = state.command.kind;
  block.owned = state.chosen;
  block.motion_scale = model.motion_scale;
  const double told = state.command.signal.value(time);
  const Interval& own = block.kind == model::CommandKind::motion ? motion : effort;
  if (block.kind == model::CommandKind::input && model.joint >= 0) {
    block.kind = model::CommandKind::motion;
    const double way = std::isinf(time_step) ? 0.0 : told * time_step;
    block.value = std::clamp(setpoint(model, state) + way, motion.min, motion.max);
    return block;
  }
  block.value = block.kind == model::CommandKind::input ? told : std::clamp(told, own.min, own.max);
  if (model.drive == nullptr || block.owned) return block;
  if (!model.drive->acts_on(block.kind)) return block;
  block.drive = model.drive.get();
  block.drive_step = {block.kind, block.value, time_step, state.motion, {}};
  std::ranges::copy(drive_state, block.drive_step.state.begin());
  return block;
}

bool is_slack(const model::ActuatorModel& model, double effort) {
  return model.kind->pulls_only && !(effort > 0.0);
}

bool is_limited_motor(const model::ActuatorModel& model, const law::ActuatorBlock& block) {
  const bool told = block.kind == model::CommandKind::motion && !block.owned;
  return model.joint >= 0 && told && !block.holds_motion();
}

}  // namespace

Interval reachable(const model::Limits& limits, double now, double time_step) {
  const double reach = std::isinf(limits.rate) ? limits.rate : limits.rate * time_step;
  Interval interval{std::max(limits.min, now - reach), std::min(limits.max, now + reach)};
  if (interval.min <= interval.max) return interval;
  const double nearest = now > limits.max ? interval.min : interval.max;
  return {nearest, nearest};
}

Actuation::Actuation(const model::Model& model)
    : model_(model),
      states_(model.actuators().size()),
      motions_before_(states_.size()),
      drives_(static_cast<std::size_t>(model.drive_states()), 0.0) {
  restart();
}

std::span<const double> Actuation::drive_state(int actuator) const {
  const model::ActuatorModel& model = model_.actuators()[static_cast<std::size_t>(actuator)];
  if (model.drive == nullptr) return {};
  return std::span(drives_).subspan(static_cast<std::size_t>(model.first_state),
                                    static_cast<std::size_t>(model.drive->state_size()));
}

std::span<double> Actuation::numbers_of(std::size_t actuator) {
  return std::span(drives_).subspan(
      static_cast<std::size_t>(model_.actuators()[actuator].first_state),
      drive_state(static_cast<int>(actuator)).size());
}

void Actuation::command(int actuator, model::Command command, const void* by) {
  model::ActuatorState& state = states_.at(static_cast<std::size_t>(actuator));
  if (state.owner != by) {
    throw Error(ErrorKind::actuator_owned,
                {.item = model_.actuators()[static_cast<std::size_t>(actuator)].name},
                "a controller owns this actuator", "detach the controller first");
  }
  check_held(actuator, command);
  model_.actuators()[static_cast<std::size_t>(actuator)].check_command(command);
  state.command = std::move(command);
}

void Actuation::check_held(int actuator, const model::Command& command) const {
  const model::ActuatorModel& model = model_.actuators()[static_cast<std::size_t>(actuator)];
  if (!model::keeps_effort_errors(model_.step()) || !model.holds_motion(command.kind)) return;
  model::check_held_radius(model_.step(), fmt::format("the command of '{}' holds", model.name));
}

void Actuation::set_commands(const std::vector<model::Command>& commands) {
  for (std::size_t i = 0; i < states_.size(); ++i) check_held(static_cast<int>(i), commands[i]);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const bool told = states_[i].owner != nullptr && !states_[i].chosen;
    if (!told) states_[i].command = commands[i];
  }
}

void Actuation::own(const void* owner, std::span<const int> actuators, bool chosen) {
  for (const int index : actuators) {
    model::ActuatorState& state = states_.at(static_cast<std::size_t>(index));
    state.owner = owner;
    state.chosen = chosen;
  }
}

// A winch holds its length, a regulator its pressure.
void Actuation::release(const void* owner) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    model::ActuatorState& state = states_[i];
    if (state.owner != owner) continue;
    state.owner = nullptr;
    if (!std::exchange(state.chosen, false)) continue;
    state.command =
        model_.actuators()[i].kind->regulates_effort
            ? model::Command{model::CommandKind::effort, model::Signal::constant(state.effort)}
            : model::Command{model::CommandKind::motion, model::Signal::constant(state.motion)};
  }
}

void Actuation::form_blocks(double time, double time_step,
                            std::span<law::ActuatorBlock> blocks) const {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    blocks[i] = actuator_block(model_.actuators()[i], states_[i], drive_state(static_cast<int>(i)),
                               time, time_step);
  }
}

void Actuation::read(const VectorX& delta, std::span<const double> effort,
                     std::span<const law::ActuatorBlock> blocks) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    model::ActuatorState& state = states_[i];
    const law::ActuatorBlock& block = blocks[i];
    const model::ActuatorModel& model = model_.actuators()[i];
    motions_before_[i] = state.motion;
    state.effort = effort[static_cast<std::size_t>(model.row)];
    state.motion = delta[model.row];
    state.slack = is_slack(model, state.effort);
    const bool commanded =
        !block.owned && block.kind == model::CommandKind::motion && block.row >= 0;
    state.setpoint = commanded ? block.value : state.motion;
  }
}

void Actuation::advance_drives(std::span<const law::ActuatorBlock> blocks) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const model::ActuatorModel& model = model_.actuators()[i];
    if (model.drive == nullptr) continue;
    model::Drive::Step step = blocks[i].drive_step;
    std::ranges::copy(numbers_of(i), step.state.begin());
    model.drive->advance(step, states_[i].motion, states_[i].effort, numbers_of(i));
  }
}

void Actuation::restart() {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const model::ActuatorModel& model = model_.actuators()[i];
    if (!states_[i].chosen) states_[i].command = model.command;
    if (model.drive != nullptr) model.drive->rest(numbers_of(i));
  }
}

void Actuation::save(State& state) const {
  state.motions.resize(states_.size());
  state.setpoints.resize(states_.size());
  std::ranges::transform(states_, state.motions.begin(), &model::ActuatorState::motion);
  std::ranges::transform(states_, state.setpoints.begin(), &model::ActuatorState::setpoint);
  state.drives = drives_;
}

void Actuation::load(const State& state) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const model::ActuatorModel& model = model_.actuators()[i];
    states_[i].motion = state.motions[i];
    states_[i].setpoint = state.setpoints[i];
    states_[i].effort = state.efforts[static_cast<std::size_t>(model.row)];
    states_[i].slack = is_slack(model, states_[i].effort);
  }
  drives_ = state.drives;
}

void blend(std::span<law::ActuatorBlock> blocks, std::span<const model::ActuatorState> start,
           double fraction) {
  for (std::size_t i = 0; i < start.size(); ++i) {
    law::ActuatorBlock& block = blocks[i];
    if (block.owned || block.kind == model::CommandKind::input) continue;
    const double from =
        block.kind == model::CommandKind::effort ? start[i].effort : start[i].motion;
    block.value = (1.0 - fraction) * from + fraction * block.value;
    block.drive_step.command = block.value;
  }
}

bool limits_motors(const model::Model& model, std::span<const law::ActuatorBlock> blocks) {
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    if (is_limited_motor(model.actuators()[i], blocks[i])) return true;
  }
  return false;
}

void lift_motor_limits(const model::Model& model, std::span<law::ActuatorBlock> blocks) {
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    if (!is_limited_motor(model.actuators()[i], blocks[i])) continue;
    blocks[i].effort_min = -kInfinity;
    blocks[i].effort_max = kInfinity;
  }
}

bool keeps_motor_limits(const model::Model& model, std::span<const law::ActuatorBlock> blocks,
                        std::span<const double> effort) {
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    const law::ActuatorBlock& block = blocks[i];
    if (model.actuators()[i].joint < 0 || block.row < 0) continue;
    const double own = effort[static_cast<std::size_t>(block.row)];
    if (own < block.effort_min || own > block.effort_max) return false;
  }
  return true;
}

void hold_efforts(std::span<law::ActuatorBlock> blocks, std::span<const double> effort) {
  for (law::ActuatorBlock& block : blocks) {
    if (block.owned) block.hold_effort(effort[static_cast<std::size_t>(block.row)]);
  }
}

void command_efforts(std::span<law::ActuatorBlock> blocks, std::span<const double> effort) {
  for (law::ActuatorBlock& block : blocks) {
    if (block.owned) block.command_effort(effort[static_cast<std::size_t>(block.row)]);
  }
}

}  // namespace sinew::run
