#include <memory>
#include <utility>

#include <fmt/format.h>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/builder/force_settings.hpp"
#include "sinew/builder/torque_settings.hpp"
#include "sinew/constraint/coordinate_force.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/has_arm.hpp"

namespace sinew::builder {

namespace {

/// The arm's coordinate on which the torque acts. @param name of the body.
int coordinate_of(const TorqueSettings& settings, const pcc::Arm& arm, const std::string& name) {
  if (settings.segment < 0 || settings.segment >= arm.segments()) {
    throw Error(ErrorKind::index_out_of_range, settings.place,
                fmt::format("arm '{}' has no segment {}", name, settings.segment),
                fmt::format("name 0 to {}", arm.segments() - 1));
  }
  const auto& segment = arm.settings().segments[static_cast<std::size_t>(settings.segment)];
  const int along = static_cast<int>(settings.towards);
  if (along >= segment.coordinates()) {
    throw Error(ErrorKind::unknown_choice, settings.place,
                fmt::format("segment {} of arm '{}' does not bend so", settings.segment, name),
                settings.towards == TorqueSettings::Towards::across
                    ? "a planar segment bends towards x alone: write bending: spatial"
                    : "it is not extensible: give it an axial_stiffness");
  }
  return arm.first(settings.segment) + along;
}

}  // namespace

int add_torque(model::ModelData& data, const TorqueSettings& settings) {
  mechanics::BodyModel& on = find_body(data, settings.body, settings.place);
  try {
    auto* bends = mechanics::as<pcc::HasArm>(on);
    if (bends == nullptr) {
      throw Error(ErrorKind::wrong_type, settings.place,
                  fmt::format("body '{}' has no bends", on.name()),
                  "a torque acts on a segment of a body of type pcc");
    }
    const int site = bends->attach_coordinate(coordinate_of(settings, bends->arm(), on.name()));
    auto torque = std::make_unique<constraint::CoordinateForce>(
        settings.name, mechanics::Coordinate{{settings.body, site}});
    const model::ActuatorKind& kind =
        settings.towards == TorqueSettings::Towards::along ? kForceKind : kTorqueKind;
    return add_actuator(
        data, {settings.name, &kind, -1, -1, settings.torque, settings.angle, settings.command},
        std::move(torque), settings.place);
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

}  // namespace sinew::builder
