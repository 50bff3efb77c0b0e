/// @file
/// Anchor springs of bodies that only joints hold, see AnchorModel.
#pragma once

namespace sinew::sim {

struct ModelData;

/// Anchors three nodes of a body to the world. @param data receives the anchors.
/// @param body index of the body.
void add_anchors(ModelData& data, int body);

}  // namespace sinew::sim
