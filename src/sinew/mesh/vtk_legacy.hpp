/// @file
/// Reader of VTK legacy files ("The VTK User's Guide", 11th ed., file formats, simple legacy
/// formats; and the cell layout with offsets of version 5.1).
#pragma once

#include <string>
#include <string_view>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Reads an unstructured grid, ASCII or big-endian binary, versions 1.0 to 5.x. Lengths stay in
/// file units, and geometry is not checked (see check()). Works in memory, so that it can be
/// fuzzed. Throws Error (malformed-file, truncated-file, unknown-format, unsupported-version,
/// index-out-of-range, unsupported-element, size-limit), with file and line or byte.
/// @param bytes the whole file.
/// @param name its name, for messages.
Mesh read_vtk_legacy(std::string_view bytes, const std::string& name);

}  // namespace sinew::mesh
