/// @file
/// Meshes and surfaces stretched along the axes.
#pragma once

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Multiplies coordinates. A mirror image keeps positive elements and outward triangles: their
/// nodes are reordered.
/// @param shape to stretch in place. @param factors along x, y, z; of either sign, not zero.
/// @{
void scale(Mesh& shape, const Vector3& factors);
void scale(Surface& shape, const Vector3& factors);
/// @}

}  // namespace sinew::mesh
