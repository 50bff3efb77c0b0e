/// @file
/// Reader of Gmsh mesh files ("Gmsh reference manual", section "Gmsh file formats": MSH 4.1 and the
/// legacy MSH 2).
#pragma once

#include <string>
#include <string_view>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Reads Gmsh versions 2.0 to 2.2 and 4.1, ASCII and binary of either byte order. Physical groups
/// become sets with their name, or `physical:TAG` without one. Nodes keep the order of the file,
/// whatever their tags. Lengths stay in file units, and geometry is not checked. Works in memory,
/// so that it can be fuzzed. Throws Error (malformed-file, truncated-file, unsupported-version,
/// index-out-of-range, duplicate-node for a repeated tag, unsupported-element, size-limit) with
/// file and line or byte.
/// @param bytes the whole file.
/// @param name its name, for messages.
Mesh read_gmsh(std::string_view bytes, const std::string& name);

}  // namespace sinew::mesh
