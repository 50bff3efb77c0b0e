/// @file
/// Anchor springs of bodies that only joints hold, see AnchorModel.
#pragma once

#include <span>

#include "sinew/core/types.hpp"

namespace sinew::sim {

struct ModelData;

/// Anchors three nodes of a body to the world. @param data receives the anchors.
/// @param body index of the body. @param nodes of a part of it; empty: of its whole mesh.
void add_anchors(ModelData& data, int body, std::span<const NodeId> nodes);

}  // namespace sinew::sim
