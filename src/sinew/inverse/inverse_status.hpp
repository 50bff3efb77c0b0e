/// @file
/// How a step of inverse control served the targets.
#pragma once

#include <string_view>

namespace sinew::inverse {

/// What is claimed of the place where a robot rests is claimed only once it rests: effectors and
/// actuators move less than a thousandth of the tolerance in a step, and forces balance.
enum class InverseStatus {
  not_started,    ///< no step yet
  on_target,      ///< every effector within the tolerance, and the last step went as foreseen
  moving,         ///< on the way
  rate_limited,   ///< on the way, and limits on rates bind
  out_of_reach,   ///< at rest, and limits keep the effectors from coming nearer
  local_optimum,  ///< at rest: no small change of efforts comes nearer, and no limit is in the way
  limits_conflict,  ///< limits contradict each other in this step; the least violation was taken
  at_limits,        ///< of a closed loop: off target, and limits hold the effectors back
  holding,          ///< of a closed loop: a sensor is silent, and all commands are held
};
inline constexpr int kInverseStatuses = 9;
/// "not-started", "on-target", "moving", "rate-limited", "out-of-reach", "local-optimum",
/// "limits-conflict", "at-limits", "holding".
std::string_view inverse_status_name(InverseStatus status);

}  // namespace sinew::inverse
