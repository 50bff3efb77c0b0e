/// @file
/// Named sets as 8-bit masks, for VTK files; internal to this folder.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Masks by the name of the set: 1 for members, 0 for others.
using SetMasks = std::map<std::string, std::vector<std::uint8_t>>;

/// Masks of node sets, with a value for each node.
SetMasks node_masks(const Mesh& mesh);

/// Masks of element sets, with a value for each tetrahedron, hexahedron and, if requested,
/// triangle.
/// @param mesh with the sets. @param triangles whether surface triangles are cells, too.
SetMasks cell_masks(const Mesh& mesh, bool triangles);

}  // namespace sinew::mesh
