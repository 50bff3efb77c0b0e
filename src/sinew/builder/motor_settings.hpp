/// @file
/// A motor as an actuator.
#pragma once

#include <string>

#include "sinew/core/error.hpp"
#include "sinew/model/actuator.hpp"

namespace sinew::builder {

/// A motor of a hinge or slider.
struct MotorSettings {
  std::string name;
  Location place;
  int joint = 0;                 ///< index returned by add_joint()
  bool linear = false;           ///< whether the joint is a slider
  model::Limits effort, motion;  ///< N m and rad; N and m
  model::Command command;
};

}  // namespace sinew::builder
