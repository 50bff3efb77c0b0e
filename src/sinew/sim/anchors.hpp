/// @file
/// Springs that hold in statics what only joints hold.
#pragma once

namespace sinew::sim {

struct ModelData;

/// Anchors three nodes of a body. @param data gets the anchors. @param body its number.
void add_anchors(ModelData& data, int body);

}  // namespace sinew::sim
