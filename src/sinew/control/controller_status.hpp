/// @file
/// Status of a controller after a step.
#pragma once

#include <string_view>

namespace sinew::control {

/// Status of the targets after a step. The statuses of a robot at rest are given only if it rests:
/// effectors and actuators move by at most 2e-4 of the tolerance in a step, and forces balance to
/// 1e-3.
enum class ControllerStatus {
  not_started,      ///< no step yet
  on_target,        ///< every effector is within the tolerance, and the last prediction held
  moving,           ///< moving towards the targets
  rate_limited,     ///< moving towards the targets, and limits on rates are active
  out_of_reach,     ///< at rest, and limits keep the effectors from coming nearer
  local_optimum,    ///< at rest: no small change of efforts comes nearer, and no limit is active
  limits_conflict,  ///< limits contradict each other in this step; they are violated least
  at_limits,        ///< closed loop: off target, and limits hold the effectors back
  holding,          ///< closed loop: a sensor is silent, and all commands are held
  held_back,        ///< at rest: larger steps failed or missed their predictions, see StepDamping
};
inline constexpr int kControllerStatuses = 10;
/// "not-started", "on-target", "moving", "rate-limited", "out-of-reach", "local-optimum",
/// "limits-conflict", "at-limits", "holding", "held-back".
std::string_view controller_status_name(ControllerStatus status);
/// The status of a number in a saved state; the first or last one for numbers beyond them.
ControllerStatus controller_status_of(double number);

}  // namespace sinew::control
