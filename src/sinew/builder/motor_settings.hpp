/// @file
/// A motor as an actuator.
#pragma once

#include <string>

#include "sinew/core/error.hpp"
#include "sinew/model/actuator.hpp"

namespace sinew::builder {

/// The kinds of motors of hinges and of sliders.
inline constexpr model::ActuatorKind kMotorKind{.word = "motor",
                                                .effort = {"torque", "N m"},
                                                .motion = {"angle", "rad"},
                                                .inputs = {{{"velocity", "rad/s"}}},
                                                .number = 5};
inline constexpr model::ActuatorKind kLinearMotorKind{.word = "linear-motor",
                                                      .effort = {"force", "N"},
                                                      .motion = {"displacement", "m"},
                                                      .inputs = {{{"velocity", "m/s"}}},
                                                      .number = 6};

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
