/// @file
/// Check that every body is supported in statics: by fixed nodes, or by joints to supported bodies
/// or to the world.
#pragma once

#include <vector>

#include "sinew/core/error.hpp"

namespace sinew::model {
struct ModelData;
}

namespace sinew::builder {

/// Anchors the bodies that are supported by joints only. Call when all bodies and joints are added.
/// @param data receives the anchors.
/// @param places (bodies,) source locations.
/// Throws Error(nothing-fixed) in statics for a body with a free rigid motion.
void hold_bodies(model::ModelData& data, const std::vector<Location>& places);

}  // namespace sinew::builder
