/// @file
/// The status of a step, which callers should check.
#pragma once

#include <string>
#include <string_view>

#include "sinew/model/step_settings.hpp"

namespace sinew::run {

/// In order of severity; a step has the most severe status that applies.
enum class StepStatus {
  solved,               ///< the equation of motion holds to the tolerance
  limits_conflict,      ///< limits contradict each other; the violation was minimised
  command_not_reached,  ///< a commanded motion was not reached, though no limit prevents it
  cavitates,            ///< a chamber would need a pressure below vacuum for its volume
  cut_back,             ///< part of the motion was made: the whole would have inverted elements
  gaining_energy,       ///< the energy grew by more than the work done: results are unphysical
  after_failure,        ///< the step started from a state that descends from a failed step
  not_in_equilibrium,   ///< failure: forces are not balanced at the end, the state is no solution
  unphysical,           ///< failure: no robot has such a state, see Sanity
};
inline constexpr StepStatus kLastStepStatus = StepStatus::unphysical;

/// Whether the results are unreliable: true for all after limits_conflict, which is a property of
/// the robot and its commands.
constexpr bool is_flagged(StepStatus status) { return status > StepStatus::limits_conflict; }

/// Whether the step failed: its state solves nothing, and nothing continues from it unless the
/// caller asks for that (Simulation::step()).
constexpr bool is_failure(StepStatus status) { return status >= StepStatus::not_in_equilibrium; }

/// "solved", "limits-conflict", "command-not-reached", "cavitates", "cut-back", "gaining-energy",
/// "after-failure", "not-in-equilibrium", "unphysical".
std::string_view step_status_name(StepStatus status);

/// Suggests a remedy as a clause; empty for `solved`. `step` has the settings of the flagged step:
/// the remedy does not name what is already chosen.
std::string step_status_remedy(StepStatus status, const model::StepSettings& step);

}  // namespace sinew::run
