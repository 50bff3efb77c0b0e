/// @file
/// Where equilibria under a growing pressure end.
#pragma once

#include <span>
#include <string>

#include "sinew/law/step_problem.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::statics {

/// Names a chamber whose pressure hardly increases with its volume any more, compared with its mean
/// increase so far, and which has not reached its command: "chamber 'air' has no equilibrium at 35
/// kPa: about 7.11 kPa its pressure reaches a peak (limit point), where it has grown by 19.6 ml".
/// Empty if there is none. The pressure of a balloon has such a peak, as does, with the sign of a
/// vacuum, that of a wall that buckles inwards.
/// @param run at the last equilibrium on the way, linearised with the exact tangent and condensed.
/// @param goal (actuators,) blocks with the full commands.
std::string describe_limit_point(const run::Run& run, std::span<const law::ActuatorBlock> goal);

/// What helps where describe_limit_point() names a chamber.
inline constexpr const char* kLimitPointRemedy =
    "command its volume_growth, which passes the peak, or use follow_path() or dynamics "
    "(`integrator: backward-euler`), in which it snaps";

}  // namespace sinew::statics
