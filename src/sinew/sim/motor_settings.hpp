/// @file
/// A motor as an actuator.
#pragma once

#include <string>

#include "sinew/core/error.hpp"
#include "sinew/sim/actuator.hpp"

namespace sinew::sim {

/// A motor of a hinge or slider.
struct MotorSettings {
  std::string name;
  Location place;
  int joint = 0;          ///< index returned by add_joint()
  bool linear = false;    ///< whether the joint is a slider
  Limits effort, motion;  ///< N m and rad; N and m
  Command command;
};

}  // namespace sinew::sim
