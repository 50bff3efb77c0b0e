/// @file
/// What the user of a view should know of a robot's present state.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace sinew::inverse {
class TargetController;
}
namespace sinew::sim {
class Simulation;
}

namespace sinew::viewer {

/// Limits that are reached, slack cables, what the controller cannot do, and a flagged step: each
/// with level, kind, subject and text. @param simulation of the robot, as it is now.
/// @param controller,name what steers, null: nothing.
nlohmann::json list_troubles(const sim::Simulation& simulation,
                             const inverse::TargetController* controller, const std::string& name);

}  // namespace sinew::viewer
