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

ActuatorRange actuator_range(const ActuatorModel& model, const ActuatorState& state,
                             std::span<const double> drive_state, double time, double time_step) {
  const Interval effort = reachable(model.effort, state.effort, time_step);
  const Interval motion = reachable(model.motion, state.wound, time_step);
  ActuatorRange range;
  range.row = model.row;
  range.effort_min = effort.min;
  range.effort_max = effort.max;
  range.motion_min = motion.min;
  range.motion_max = motion.max;
  range.kind = state.command.kind;
  range.owned = state.owner != nullptr;
  range.motion_scale = model.motion_scale;
  const double told = state.command.signal.value(time);
  const Interval& own = range.kind == CommandKind::motion ? motion : effort;
  range.value = range.kind == CommandKind::input ? told : std::clamp(told, own.min, own.max);
  if (model.drive == nullptr || range.owned) return range;
  if (!model.drive->acts_on(range.kind)) return range;
  range.drive = model.drive.get();
  range.drive_step = {range.kind, range.value, time_step, state.motion, drive_state};
  return range;
}

void blend(ActuatorRange& range, const ActuatorState& start, double fraction) {
  if (range.owned || range.kind == CommandKind::input) return;
  const double from = range.kind == CommandKind::effort ? start.effort : start.motion;
  range.value = (1.0 - fraction) * from + fraction * range.value;
  range.drive_step.command = range.value;
}

}  // namespace sinew::sim
