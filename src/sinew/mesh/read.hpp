/// @file
/// Reading volume meshes of all known formats.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Options for reading a mesh file.
struct ReadOptions {
  double unit = 1.0;        ///< m per file unit: 0.001 for a file in mm
  bool unit_given = false;  ///< the user gave the unit: accept any size
  bool allow_several_components = false;
};

/// Reads a mesh, scales it to metres and checks it. The format (VTK legacy, VTU or Gmsh) is
/// recognised by content. Throws Error: file-not-found, file-unreadable, unknown-format, and the
/// errors of read_vtk_legacy(), read_vtu(), read_gmsh() and check().
/// @param path the file.
/// @param options unit, and what to accept.
Mesh read_mesh(const std::filesystem::path& path, const ReadOptions& options = {});

/// Like read_mesh(), without reordering and checks, so that a defective mesh can be described.
/// @param path the file.
/// @param options only the unit is used.
Mesh read_mesh_unchecked(const std::filesystem::path& path, const ReadOptions& options = {});

/// Like read_mesh_unchecked(), from memory; lengths stay in file units.
/// @param bytes the whole file.
/// @param name its name, for messages.
Mesh parse_mesh(std::string_view bytes, const std::string& name);

}  // namespace sinew::mesh
