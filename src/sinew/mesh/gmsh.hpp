/// @file
/// Reader of Gmsh's mesh files ("Gmsh reference manual", section "Gmsh file formats": MSH 4.1 and
/// the legacy MSH 2).
#pragma once

#include <string>
#include <string_view>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Versions 2.0 to 2.2 and 4.1, ASCII and binary of either byte order. Physical groups become sets
/// under their name, or `physical:TAG` without one. Nodes keep the file's order, whatever their
/// tags. Lengths stay in file units, geometry is not checked. Touches no file, so that it can be
/// fuzzed. Throws Error (malformed-file, truncated-file, unsupported-version, index-out-of-range,
/// duplicate-node for a tag given twice, unsupported-element, size-limit) with file and line or
/// byte.
/// @param bytes the whole file.
/// @param name its name, for messages.
Mesh read_gmsh(std::string_view bytes, const std::string& name);

}  // namespace sinew::mesh
