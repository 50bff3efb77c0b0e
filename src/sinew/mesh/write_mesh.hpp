/// @file
/// Writes a mesh in the format that the file's name asks for.
#pragma once

#include <filesystem>
#include <string>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Lengths in m, by the ending, in letters of either case:
///   .vtu  VTK XML, what write_vtu() writes;
///   .vtk  VTK legacy, what format_vtk_legacy() makes;
///   .stl  binary STL of the outside alone (boundary_surface()), in single precision.
/// The file appears whole or not at all. Throws Error(unknown-format) for another ending, and
/// Error(file-unwritable).
/// @param path the file.
/// @param mesh to write.
void write_mesh(const std::filesystem::path& path, const Mesh& mesh);

/// Throws Error(unknown-format) unless write_mesh() knows the ending.
/// @param path the file.
void require_writable_format(const std::filesystem::path& path);

/// A VTK legacy file, version 4.2, binary ("The VTK User's Guide", 11th ed., simple legacy
/// formats): tetrahedra, hexahedra and triangles, and the named sets as 8-bit masks, which
/// read_mesh() reads back.
/// @param mesh to write.
std::string format_vtk_legacy(const Mesh& mesh);

}  // namespace sinew::mesh
