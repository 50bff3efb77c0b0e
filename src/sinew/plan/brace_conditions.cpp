#include "sinew/plan/brace_conditions.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::plan {

using Verdict = BraceCondition::Verdict;

FrictionRange friction_range(std::string_view name) {
  for (const FrictionRange& range : {kCoatedRigid, kSiliconeOnSteel}) {
    if (range.name == name) return range;
  }
  throw Error(
      ErrorKind::unknown_choice, {.item = "friction"},
      fmt::format("there is no pair of surfaces '{}'", name),
      fmt::format("use '{}', '{}' or a coefficient", kCoatedRigid.name, kSiliconeOnSteel.name));
}

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::holds:
      return "holds";
    case Verdict::uncertain:
      return "uncertain";
    case Verdict::violated:
      break;
  }
  return "violated";
}

BraceCondition check_friction(double normal_force, double friction_force,
                              const FrictionRange& friction) {
  BraceCondition result{"friction", Verdict::violated, 0.0, friction.min};
  result.value =
      normal_force > 0.0 ? friction_force / normal_force : std::numeric_limits<double>::infinity();
  if (result.value < friction.min) {
    result.verdict = Verdict::holds;
  } else if (result.value < friction.max) {
    result.verdict = Verdict::uncertain;
  }
  return result;
}

BraceCondition check_stiffness(const TouchStiffness& object, const TouchStiffness& arm,
                               double ratio) {
  const double value = std::min(object.radial / arm.radial, object.torsional / arm.torsional);
  return {"stiffness", value >= ratio ? Verdict::holds : Verdict::violated, value, ratio};
}

BraceCondition check_kinematics(double gap, double clearance, double tip_excess, double tolerance) {
  const double value = std::max({std::abs(gap), -clearance, tip_excess});
  return {"kinematic", value <= tolerance ? Verdict::holds : Verdict::violated, value, tolerance};
}

}  // namespace sinew::plan
