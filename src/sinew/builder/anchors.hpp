/// @file
/// Anchor springs of bodies that only joints hold, see AnchorModel.
#pragma once

#include <span>

#include "sinew/core/types.hpp"

namespace sinew::model {
struct ModelData;
}

namespace sinew::builder {

/// Anchors three nodes of a body to the world. @param data receives the anchors.
/// @param body index of the body. @param nodes of a part of it; empty: of its whole mesh.
void add_anchors(model::ModelData& data, int body, std::span<const NodeId> nodes);

}  // namespace sinew::builder
