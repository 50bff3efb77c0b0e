/// @file
/// Scaling of meshes and surfaces along the axes.
#pragma once

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Multiplies coordinates by factors. If that mirrors the shape, nodes are reordered so that
/// elements stay positive and triangles outward.
/// @param shape to scale in place. @param factors along x, y, z; of either sign, not zero.
/// @{
void scale(Mesh& shape, const Vector3& factors);
void scale(Surface& shape, const Vector3& factors);
/// @}

}  // namespace sinew::mesh
