// What a model has of constant-curvature arms: the bodies and the torques on their bends.
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/point_force.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/pcc/arm_body.hpp"
#include "sinew/sim/model_builder.hpp"

namespace sinew::sim {

int ModelBuilder::add_arm(pcc::ArmSettings settings) {
  auto body =
      std::make_unique<pcc::ArmBodyModel>(std::make_shared<const pcc::Arm>(std::move(settings)));
  model_->size_ = std::max(model_->size_, body->arm().length());
  return add_body(std::move(body));
}

int ModelBuilder::add_torque(const TorqueSettings& settings) {
  check_body(settings.body, settings.place);
  try {
    auto* arm = dynamic_cast<pcc::ArmBodyModel*>(&body(settings.body));
    if (arm == nullptr) {
      throw Error(ErrorKind::wrong_type, settings.place,
                  fmt::format("body '{}' has no bends", body(settings.body).name()),
                  "a torque acts on a segment of a body of type pcc");
    }
    const pcc::Arm& model = arm->arm();
    if (settings.segment < 0 || settings.segment >= model.segments()) {
      throw Error(ErrorKind::index_out_of_range, settings.place,
                  fmt::format("arm '{}' has no segment {}", arm->name(), settings.segment),
                  fmt::format("name 0 to {}", model.segments() - 1));
    }
    const auto& segment = model.settings().segments[static_cast<std::size_t>(settings.segment)];
    const int along = static_cast<int>(settings.towards);
    if (along >= segment.coordinates()) {
      throw Error(
          ErrorKind::unknown_choice, settings.place,
          fmt::format("segment {} of arm '{}' does not bend so", settings.segment, arm->name()),
          along == 1 ? "a planar segment bends towards x alone: write bending: spatial"
                     : "it is not extensible: give it an axial_stiffness");
    }
    const int point = arm->attach_coordinate(model.first(settings.segment) + along);
    auto torque = std::make_unique<constraint::PointForce>(
        settings.name, mechanics::MaterialPoint{settings.body, point}, Vector3::UnitX(),
        Vector3::Zero());
    const auto type = along == 2 ? ActuatorType::force : ActuatorType::torque;
    return add_actuator({settings.name, settings.place, type, -1, -1, settings.torque,
                         settings.angle, settings.command},
                        std::move(torque));
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

}  // namespace sinew::sim
