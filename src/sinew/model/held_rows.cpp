#include "sinew/model/held_rows.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::model {

bool keeps_effort_errors(const StepSettings& step) {
  return step.integrator == mechanics::Integrator::generalized_alpha &&
         step.spectral_radius > kMaxHeldRadius;
}

void check_held_radius(const StepSettings& step, const std::string& held) {
  if (!keeps_effort_errors(step)) return;
  Location place = step.place;
  place.item = "integrator.spectral_radius";
  throw Error(ErrorKind::out_of_range, place,
              fmt::format("it is {:g}, but {} a motion: errors of the holding force would change "
                          "sign in every step and hardly decay",
                          step.spectral_radius, held),
              fmt::format("write {:g} or less, or leave it out: {:g} is the default",
                          kMaxHeldRadius, StepSettings{}.spectral_radius));
}

void check_held_radius(const ModelData& data) {
  for (const JointModel& joint : data.joints) {
    check_held_radius(data.step, fmt::format("joint '{}' holds", joint.name));
  }
  for (const ActuatorModel& actuator : data.actuators) {
    if (!actuator.holds_motion(actuator.command.kind)) continue;
    check_held_radius(data.step, fmt::format("the command of '{}' holds", actuator.name));
  }
}

}  // namespace sinew::model
