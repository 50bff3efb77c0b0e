/// @file
/// Actuators: one row of H each, whose effort (N, Pa) or motion (m, m^3) is commanded within limits
/// or follows a drive.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "sinew/law/drive.hpp"
#include "sinew/model/actuator_kind.hpp"
#include "sinew/model/signal.hpp"

namespace sinew::model {

using law::CommandKind;
using law::Drive;

/// Inclusive limits on an effort (N, Pa) or a motion (m, m^3) and on its change per second.
struct Limits {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double rate = std::numeric_limits<double>::infinity();  ///< >= 0, per second
};

/// A command: the quantity and its value over time.
struct Command {
  CommandKind kind = CommandKind::effort;
  Signal signal;
};

/// The immutable part of an actuator.
struct ActuatorModel {
  std::string name;
  const ActuatorKind* kind = nullptr;  ///< a constant, see ActuatorKind
  int constraint = -1;                 ///< index in Model::constraints()
  int row = -1;                        ///< of H
  Limits effort, motion;
  Command command;                          ///< at the start of a run
  std::shared_ptr<const Drive> drive = {};  ///< none: the commands act directly
  int first_state = 0;        ///< index of its first state variable among those of all drives
  double motion_scale = 1.0;  ///< m per unit of motion: 1; for a chamber 1/m^2, one over its area
  int joint = -1;             ///< index in Model::joints() of the joint it moves; -1: none
  /// Pa, of a chamber: its pressure where the absolute pressure is zero, minus the ambient one. The
  /// limit effort.min is never below this. No liquid and no gas transmits less.
  std::optional<double> vacuum = {};

  /// Name of the drive's input, or "velocity" of a motor, rad/s or m/s; otherwise empty.
  QuantityName input_name() const;
  /// The quantity to which a command of this kind refers.
  QuantityName quantity(CommandKind by) const;
  /// The kind of command for this quantity; none if the actuator does not accept it.
  std::optional<CommandKind> kind_of(std::string_view quantity) const;
  /// Whether a command of this kind prescribes the motion, and any effort that it takes.
  bool holds_motion(CommandKind by) const;
  /// Limits of the effort for commands of a kind. A commanded volume holds whatever pressure that
  /// takes, unless the scene limits it; the step says if it would take less than vacuum.
  Limits effort_limits(CommandKind by) const;
  /// Throws Error(out-of-range) for a commanded effort below vacuum at any time. @param told any
  /// command.
  void check_command(const Command& told) const;
  /// Whether a controller may choose its effort: true without a drive.
  bool controllable() const { return drive == nullptr || drive->controllable(); }
};

/// Pa, absolute: the standard atmosphere (ISO 2533:1975), the ambient pressure if none is given.
inline constexpr double kAtmosphere = 101325.0;

/// The state of an actuator in a simulation.
struct ActuatorState {
  Command command;
  double effort = 0.0;  ///< N or Pa, of the last step
  double motion = 0.0;  ///< m or m^3, at the end of the last step
  /// m or m^3: the last commanded motion, within limits; equal to `motion` if an effort is
  /// commanded or a controller chooses it.
  double setpoint = 0.0;
  bool slack = true;            ///< whether a cable has no tension
  const void* owner = nullptr;  ///< controller or commander that owns it; null: none
  bool chosen = false;          ///< whether its owner chooses its effort; else it obeys its command
};

}  // namespace sinew::model
