#include "arm_limits.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/plan/nonlinear_program.hpp"

namespace sinew::cli {

plan::ArmLimits limits_of(const ArmScene& scene) {
  const auto bounded = [](const VectorX& values) -> VectorX {
    return values.cwiseMax(-plan::kNoBound).cwiseMin(plan::kNoBound);
  };
  plan::ArmLimits limits;
  limits.torque_lower = bounded(scene.torque_lower);
  limits.torque_upper = bounded(scene.torque_upper);
  limits.torque_rate = bounded(scene.torque_rate);
  limits.angle_lower = bounded(scene.angle_lower);
  limits.angle_upper = bounded(scene.angle_upper);
  limits.rate = bounded(scene.rate);
  return limits;
}

void require_inputs(const ArmScene& scene) {
  if (!scene.inputs.empty()) return;
  const std::string& name = scene.arm->settings().name;
  throw Error(ErrorKind::no_actuators, {.item = "actuators"},
              fmt::format("no torque drives the arm '{}'", name),
              fmt::format("add one: bend: {{type: torque, body: {}, segment: 0, limits: {{torque: "
                          "{{min: -0.1 N m, max: 0.1 N m}}}}}}",
                          name));
}

}  // namespace sinew::cli
