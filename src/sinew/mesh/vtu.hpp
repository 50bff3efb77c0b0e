/// @file
/// Reader of XML unstructured grids of VTK (.vtu; "VTK XML File Formats",
/// https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html).
#pragma once

#include <string>
#include <string_view>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Reads a VTU file: arrays as ASCII, inline base64, appended raw or appended base64, each plain or
/// zlib-compressed; header_type UInt32 or UInt64; both byte orders. Several pieces are
/// concatenated. Lengths stay in file units, and geometry is not checked. Works in memory, so that
/// it can be fuzzed. Throws Error (malformed-file, truncated-file, unknown-format,
/// index-out-of-range, unsupported-element, size-limit) with file and line or byte.
/// @param bytes the whole file.
/// @param name its name, for messages.
Mesh read_vtu(std::string_view bytes, const std::string& name);

}  // namespace sinew::mesh
