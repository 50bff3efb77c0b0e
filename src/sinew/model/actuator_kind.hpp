/// @file
/// What the actuators of one kind have in common.
#pragma once

#include <array>
#include <string_view>

#include "sinew/law/drive.hpp"

namespace sinew::model {

using law::QuantityName;

/// A kind of actuator: its names, and the answers to what the engine asks of an actuator. Each kind
/// is a constant beside the settings of its actuators, such as builder::kCableKind; new ones need
/// no list.
struct ActuatorKind {
  const char* word = "";                 ///< in scenes, Python, recordings and the view
  QuantityName effort, motion;           ///< conjugate: their product is a work, J
  std::array<QuantityName, 2> inputs{};  ///< of its drives, see Drive::input(), or of a motor
  /// Its effort is never negative, and it is slack where the effort is zero: a cable.
  bool pulls_only = false;
  /// Its row is the length of a line through points, which holds what hangs on it.
  bool is_line = false;
  /// It regulates its effort, as a valve does a pressure: a controller commands efforts, and a
  /// released one keeps its effort. Others, such as winches, take motions and keep those.
  bool regulates_effort = false;

  /// What stands for the kind in the hashes of saved states; -1: its word.
  int number = -1;

  /// Whether it moves by an angle, rad.
  bool turns() const { return std::string_view(motion.unit) == "rad"; }
  /// Whether it moves by a volume, m^3.
  bool swells() const { return std::string_view(motion.unit) == "m^3"; }
};

}  // namespace sinew::model
