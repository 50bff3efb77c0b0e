/// @file
/// In statics something has to hold every body: what is fixed of it, or joints to bodies that are
/// held, or to the world.
#pragma once

#include <vector>

#include "sinew/core/error.hpp"

namespace sinew::sim {

struct ModelData;

/// Anchors the bodies of a finished list that need joints to be held.
/// @param data gets the anchors.
/// @param places (bodies,) where each is written. Throws Error(nothing-fixed) in statics for a body
/// that keeps a rigid motion.
void hold_bodies(ModelData& data, const std::vector<Location>& places);

}  // namespace sinew::sim
