/// @file
/// A torque as an actuator.
#pragma once

#include <string>

#include "sinew/core/error.hpp"
#include "sinew/model/actuator.hpp"

namespace sinew::builder {

/// The kind of torques on segments of arms.
inline constexpr model::ActuatorKind kTorqueKind{
    .word = "torque", .effort = {"torque", "N m"}, .motion = {"angle", "rad"}, .number = 4};

/// A torque on a segment of a constant-curvature arm.
struct TorqueSettings {
  enum class Towards { side, across, along };  ///< the segment's coordinates u, v, e
  std::string name;
  Location place;
  int body = 0;
  int segment = 0;
  Towards towards = Towards::side;
  model::Limits torque;  ///< N m; along: N
  model::Limits angle;   ///< rad; along: m
  model::Command command;
};

}  // namespace sinew::builder
