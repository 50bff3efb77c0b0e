/// @file
/// Problems in a robot's current state that the user of a view should know.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace sinew::control {
class TargetController;
}
namespace sinew::sim {
class Simulation;
}

namespace sinew::viewer {

/// Lists reached limits, slack cables, problems of the controller and a flagged step, each with
/// level, kind, subject and text. @param simulation in its current state.
/// @param controller,name of the controller; null: none.
nlohmann::json list_troubles(const sim::Simulation& simulation,
                             const control::TargetController* controller, const std::string& name);

}  // namespace sinew::viewer
