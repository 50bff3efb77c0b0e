/// @file
/// What drives a robot: one row of H whose effort (N, Pa) or motion (m, m^3) is commanded within
/// limits, or follows a drive.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/sim/signal.hpp"
#include "sinew/step/drive.hpp"

namespace sinew::sim {

using step::CommandKind;
using step::Drive;
using step::QuantityName;

/// Inclusive limits on an effort (N, Pa) or a motion (m, m^3) and on its change per second.
struct Limits {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double rate = std::numeric_limits<double>::infinity();  ///< >= 0, per second
};

enum class ActuatorType { cable, force, chamber, spring, torque, motor, linear_motor };
inline constexpr std::size_t kActuatorTypes = 7;

/// What actuators of a type and their quantities are called: in scenes, Python, recordings and the
/// view.
struct ActuatorWords {
  const char* type = "";
  QuantityName effort, motion;
  std::array<QuantityName, 2> inputs = {};  ///< of its drives, see Drive::input(); of a motor
};
const ActuatorWords& actuator_words(ActuatorType type);
/// By ActuatorWords::type; none where no type has this name.
std::optional<ActuatorType> actuator_type(std::string_view word);
/// Every quantity by which some actuator is commanded, once.
const std::vector<std::string_view>& command_quantities();

/// What an actuator is told, over time.
struct Command {
  CommandKind kind = CommandKind::effort;
  Signal signal;
};

/// Immutable part of an actuator.
struct ActuatorModel {
  std::string name;
  ActuatorType type = ActuatorType::cable;
  int constraint = -1;  ///< in Model::constraints
  int row = -1;         ///< of H
  Limits effort, motion;
  Command command;                          ///< where a run begins
  std::shared_ptr<const Drive> drive = {};  ///< none: it obeys its commands as they are
  int first_state = 0;                      ///< of the drive's numbers among those of all drives
  double motion_scale = 1.0;  ///< m per motion: 1, or 1/m^2 of a chamber, one over its area
  int joint = -1;             ///< in Model::joints(), that it moves; -1: none

  const ActuatorWords& words() const { return actuator_words(type); }
  /// Of the drive; "velocity" of a motor, rad/s or m/s; none: no name.
  QuantityName input_name() const;
  /// Of what a command of this kind gives.
  QuantityName quantity(CommandKind kind) const;
  /// The command that gives this quantity; none when the actuator takes no such command.
  std::optional<CommandKind> kind_of(std::string_view quantity) const;
  /// Whether something other than its drive may choose its effort.
  bool controllable() const { return drive == nullptr || drive->controllable(); }
};

/// What an actuator is doing in a simulation.
struct ActuatorState {
  Command command;
  double effort = 0.0;  ///< N or Pa, of the last step
  double motion = 0.0;  ///< m or m^3, at the end of the last step
  /// m or m^3: the last commanded motion as far as limits let it; `motion` where an effort is
  /// commanded or a controller chooses.
  double setpoint = 0.0;
  bool slack = true;            ///< a cable without tension
  const void* owner = nullptr;  ///< the controller that has it; null: anyone may command it
  bool chosen = false;          ///< its owner chooses its effort; else it obeys its command
};

}  // namespace sinew::sim
