/// @file
/// What drives a robot: one row of H whose effort (N) or motion (m) is commanded within limits.
#pragma once

#include <limits>
#include <string>

#include "sinew/core/error.hpp"
#include "sinew/sim/signal.hpp"

namespace sinew::sim {

/// Inclusive limits on an effort (N) or a motion (m) and on its change per second.
struct Limits {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double rate = std::numeric_limits<double>::infinity();  ///< >= 0, per second
};

enum class ActuatorType { cable, force };
/// "cable", "force".
const char* actuator_type_name(ActuatorType type);

enum class CommandKind {
  effort,  ///< tension or force, N
  motion,  ///< displacement, m
};

/// What an actuator is told, over time.
struct Command {
  CommandKind kind = CommandKind::effort;
  Signal signal;
};

/// Immutable part of an actuator.
struct ActuatorModel {
  std::string name;
  Place place;
  ActuatorType type = ActuatorType::cable;
  int constraint = -1;  ///< in Model::constraints
  int row = -1;         ///< of H
  Limits effort, motion;
  Command command;  ///< where a run begins

  /// "tension" or "force"; "displacement".
  const char* effort_name() const { return type == ActuatorType::cable ? "tension" : "force"; }
  static const char* motion_name() { return "displacement"; }
};

/// What an actuator is doing in a simulation.
struct ActuatorState {
  Command command;
  double effort = 0.0;  ///< N, of the last step
  double motion = 0.0;  ///< m, at the end of the last step
  double wound =
      0.0;  ///< m, where the drive stands: its last motion command as far as limits let it
  bool slack = true;            ///< a cable without tension
  const void* owner = nullptr;  ///< the controller that has it; null: it obeys its command
};

/// What an actuator may do in the step at hand: its limits, with those on rates folded in.
struct ActuatorRange {
  int row = -1;
  double effort_min = 0.0, effort_max = 0.0;  ///< N
  double motion_min = 0.0, motion_max = 0.0;  ///< m
  CommandKind kind = CommandKind::effort;
  double value = 0.0;  ///< the command, clamped into the range
  bool owned = false;  ///< a controller chooses; value and kind do not count
};

/// The range of the step from the state before it.
/// @param model,state of one actuator, before the step.
/// @param time the end of the step (s), at which the command is read.
/// @param time_step s; infinity lifts the limits on rates.
ActuatorRange actuator_range(const ActuatorModel& model, const ActuatorState& state, double time,
                             double time_step);

}  // namespace sinew::sim
