#include <utility>

#include <fmt/format.h>

#include "sinew/builder/add_parts.hpp"
#include "sinew/constraint/constraint.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/new_name.hpp"

namespace sinew::builder {

namespace {

void check_limits(const model::Limits& limits, const char* what, const Location& place) {
  if (limits.min > limits.max) {
    throw Error(ErrorKind::contradictory_limits, place,
                fmt::format("{}: min {:g} is above max {:g}", what, limits.min, limits.max),
                "swap or widen them");
  }
  if (!(limits.rate >= 0.0)) {
    throw Error(ErrorKind::out_of_range, place,
                fmt::format("{}: rate {:g} is negative", what, limits.rate),
                "give the largest change per second, zero or more");
  }
}

}  // namespace

int add_actuator(model::ModelData& data, model::ActuatorModel actuator,
                 std::unique_ptr<constraint::Constraint> constraint, Location place) {
  model::check_new_name(data.actuators, &model::ActuatorModel::name, "actuators", actuator.name,
                        place);
  if (actuator.kind == nullptr) {
    throw Error(ErrorKind::internal, place, "an actuator without a kind",
                "set ActuatorModel::kind");
  }
  if (place.item.empty()) place.item = "actuator '" + actuator.name + "'";
  check_limits(actuator.effort, actuator.kind->effort.name, place);
  check_limits(actuator.motion, actuator.kind->motion.name, place);
  if (actuator.drive) {
    actuator.first_state = data.drive_states;
    data.drive_states += actuator.drive->state_size();
  }
  actuator.constraint = data.declare(std::move(constraint));
  actuator.row = data.constraint(actuator.constraint).first_row();
  data.actuators.push_back(std::move(actuator));
  return static_cast<int>(data.actuators.size()) - 1;
}

}  // namespace sinew::builder
