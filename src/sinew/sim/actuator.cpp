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
  return type == ActuatorType::cable ? "cable" : "force";
}

ActuatorRange actuator_range(const ActuatorModel& model, const ActuatorState& state, double time,
                             double time_step) {
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
  const Interval& own = range.kind == CommandKind::effort ? effort : motion;
  range.value = std::clamp(state.command.signal.value(time), own.min, own.max);
  return range;
}

}  // namespace sinew::sim
