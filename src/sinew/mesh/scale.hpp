/// @file
/// Meshes and surfaces stretched along the axes.
#pragma once

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Multiplies coordinates. A mirror image keeps positive elements and outward triangles: their
/// nodes are reordered.
/// @param factors along x, y, z; of either sign, not zero.
/// @{
void scale(Mesh& mesh, const Vector3& factors);
void scale(Surface& surface, const Vector3& factors);
/// @}

}  // namespace sinew::mesh
