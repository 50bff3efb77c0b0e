/// @file
/// The cables of a scene, for sim::CableWatch.
#pragma once

#include <vector>

#include "sinew/scene/build.hpp"
#include "sinew/sim/cable_watch.hpp"

namespace sinew::scene {

/// All cables, in the order of the scene. Those of whose bare points Robot::notices speaks already
/// count as chosen to be so. @param robot the scene.
std::vector<sim::WatchedCable> watched_cables(const Robot& robot);

}  // namespace sinew::scene
