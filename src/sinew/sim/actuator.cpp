#include "sinew/sim/actuator.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::sim {

namespace {

struct Interval {
  double min, max;
};

// [limits.min, limits.max] cut to what `rate` allows from `now`. A value that stands outside its
// limits moves towards them as fast as it may.
Interval reachable(const Limits& limits, double now, double time_step) {
  const double reach = std::isinf(limits.rate) ? limits.rate : limits.rate * time_step;
  Interval interval{std::max(limits.min, now - reach), std::min(limits.max, now + reach)};
  if (interval.min <= interval.max) return interval;
  const double nearest = now > limits.max ? interval.min : interval.max;
  return {nearest, nearest};
}

}  // namespace

const char* actuator_type_name(ActuatorType type) {
  switch (type) {
    case ActuatorType::cable:
      return "cable";
    case ActuatorType::force:
      return "force";
    case ActuatorType::pressure:
      return "pressure";
    case ActuatorType::spring:
      return "spring";
    case ActuatorType::torque:
      return "torque";
  }
  return "unknown";
}

QuantityName ActuatorModel::effort_name() const {
  switch (type) {
    case ActuatorType::force:
      return {"force", "N"};
    case ActuatorType::pressure:
      return {"pressure", "Pa"};
    case ActuatorType::torque:
      return {"torque", "N m"};
    case ActuatorType::cable:
    case ActuatorType::spring:
      return {"tension", "N"};
  }
  return {};
}

QuantityName ActuatorModel::motion_name() const {
  if (type == ActuatorType::pressure) return {"volume_growth", "m^3"};
  if (type == ActuatorType::torque) return {"angle", "rad"};
  return {"displacement", "m"};
}

QuantityName ActuatorModel::quantity(CommandKind kind) const {
  if (kind == CommandKind::effort) return effort_name();
  if (kind == CommandKind::motion || drive == nullptr) return motion_name();
  return drive->input();
}

std::optional<CommandKind> ActuatorModel::kind_of(std::string_view quantity) const {
  if (controllable() && quantity == effort_name().name) return CommandKind::effort;
  if (controllable() && quantity == motion_name().name) return CommandKind::motion;
  const bool known = drive != nullptr && !quantity.empty() && quantity == drive->input().name;
  return known ? std::optional(CommandKind::input) : std::nullopt;
}

step::ActuatorBlock actuator_block(const ActuatorModel& model, const ActuatorState& state,
                                   std::span<const double> drive_state, double time,
                                   double time_step) {
  const Interval effort = reachable(model.effort, state.effort, time_step);
  const Interval motion = reachable(model.motion, state.wound, time_step);
  step::ActuatorBlock block;
  block.row = model.row;
  block.effort_min = effort.min;
  block.effort_max = effort.max;
  block.motion_min = motion.min;
  block.motion_max = motion.max;
  block.kind = state.command.kind;
  block.owned = state.owner != nullptr;
  block.motion_scale = model.motion_scale;
  const double told = state.command.signal.value(time);
  const Interval& own = block.kind == CommandKind::motion ? motion : effort;
  block.value = block.kind == CommandKind::input ? told : std::clamp(told, own.min, own.max);
  if (model.drive == nullptr || block.owned) return block;
  if (!model.drive->acts_on(block.kind)) return block;
  block.drive = model.drive.get();
  block.drive_step = {block.kind, block.value, time_step, state.motion, {}};
  std::ranges::copy(drive_state, block.drive_step.state.begin());
  return block;
}

void blend(step::ActuatorBlock& block, const ActuatorState& start, double fraction) {
  if (block.owned || block.kind == CommandKind::input) return;
  const double from = block.kind == CommandKind::effort ? start.effort : start.motion;
  block.value = (1.0 - fraction) * from + fraction * block.value;
  block.drive_step.command = block.value;
}

}  // namespace sinew::sim
