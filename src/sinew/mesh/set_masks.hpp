/// @file
/// Named sets as a mask of 8 bits each, as VTK's files carry them. Internal to this folder.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// By the set's name: 1 for what is in it.
using SetMasks = std::map<std::string, std::vector<std::uint8_t>>;

/// Sets of nodes, a value for each node.
SetMasks node_masks(const Mesh& mesh);

/// Sets of elements, a value for each tetrahedron, hexahedron and, where asked, triangle.
/// @param mesh its sets. @param triangles whether surface triangles are cells, too.
SetMasks cell_masks(const Mesh& mesh, bool triangles);

}  // namespace sinew::mesh
