/// @file
/// How a step went, in one word that callers must look at.
#pragma once

#include <string_view>

namespace sinew::sim {

/// From good to bad; a step has the worst that applies.
enum class StepStatus {
  solved,               ///< its equation holds to the tolerance
  limits_conflict,      ///< limits contradict each other; the least violation was taken
  command_not_reached,  ///< a motion was commanded, nothing limits it, and it was not made
  cut_back,             ///< elements would have inverted: a part of the motion was made
  not_in_equilibrium,   ///< forces are out of balance at its end: the state is not an answer
  gaining_energy,       ///< more energy than was put in: the numbers are not those of a robot
};

/// Whether its numbers are not those of the robot: all after limits_conflict, which is the robot's
/// own affair.
constexpr bool is_flagged(StepStatus status) { return status > StepStatus::limits_conflict; }

/// "solved", "limits-conflict", "command-not-reached", "cut-back", "not-in-equilibrium", "gaining-energy".
std::string_view step_status_name(StepStatus status);

/// What to do about it, in a clause; empty for solved.
std::string_view step_status_remedy(StepStatus status);

}  // namespace sinew::sim
