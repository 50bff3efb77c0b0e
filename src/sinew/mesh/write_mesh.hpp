/// @file
/// Writing a mesh in the format given by the file name.
#pragma once

#include <filesystem>
#include <string>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Writes a mesh, in m. The ending, in upper or lower case, selects the format:
///   .vtu  VTK XML, as write_vtu();
///   .vtk  VTK legacy, as format_vtk_legacy();
///   .stl  binary STL of the outer surface (boundary_surface()), in single precision.
/// The file is written atomically. Throws Error(unknown-format) for another ending, and
/// Error(file-unwritable).
/// @param path the file.
/// @param mesh to write.
void write_mesh(const std::filesystem::path& path, const Mesh& mesh);

/// Throws Error(unknown-format) unless write_mesh() supports the ending.
/// @param path the file.
void require_writable_format(const std::filesystem::path& path);

/// Formats a mesh as binary VTK legacy file, version 4.2 ("The VTK User's Guide", 11th ed., simple
/// legacy formats): tetrahedra, hexahedra and triangles, and the named sets as 8-bit masks, which
/// read_mesh() reads back.
/// @param mesh to write.
std::string format_vtk_legacy(const Mesh& mesh);

}  // namespace sinew::mesh
