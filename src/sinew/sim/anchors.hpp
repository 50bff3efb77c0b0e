/// @file
/// Springs that hold in statics what only welds to other bodies hold.
#pragma once

namespace sinew::sim {

struct ModelData;

/// Anchors three nodes of a body. @param body of finite elements, by its number.
void add_anchors(ModelData& data, int body);

}  // namespace sinew::sim
