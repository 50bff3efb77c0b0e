/// @file
/// A torque as an actuator.
#pragma once

#include <string>

#include "sinew/core/error.hpp"
#include "sinew/sim/actuator.hpp"

namespace sinew::sim {

/// A torque on a segment of a constant-curvature arm.
struct TorqueSettings {
  enum class Towards { side, across, along };  ///< the segment's coordinates u, v, e
  std::string name;
  Location place;
  int body = 0;
  int segment = 0;
  Towards towards = Towards::side;
  Limits torque;  ///< N m; along: N
  Limits angle;   ///< rad; along: m
  Command command;
};

}  // namespace sinew::sim
