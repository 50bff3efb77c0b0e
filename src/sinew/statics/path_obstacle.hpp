/// @file
/// What the following of paths does not support.
#pragma once

#include <optional>

#include "sinew/core/error.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::statics {

/// The error that names a part of the robot which PathStep does not support; none if it supports
/// all. Actuators are not considered: see PathLoads.
std::optional<Error> find_path_obstacle(const run::Run& run);

}  // namespace sinew::statics
