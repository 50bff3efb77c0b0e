/// @file
/// A motor as an actuator.
#pragma once

#include <string>

#include "sinew/core/error.hpp"
#include "sinew/sim/actuator.hpp"

namespace sinew::sim {

/// What moves a hinge or slider.
struct MotorSettings {
  std::string name;
  Location place;
  int joint = 0;          ///< as add_joint() returned it
  bool linear = false;    ///< of a slider
  Limits effort, motion;  ///< N m and rad; N and m
  Command command;
};

}  // namespace sinew::sim
