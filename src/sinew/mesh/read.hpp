/// @file
/// Reads volume meshes of any known format from a file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// How to take a mesh file.
struct ReadOptions {
  double unit = 1.0;        ///< m per file unit: 0.001 for a file in mm
  bool unit_given = false;  ///< the unit was chosen by someone, so that any size is believed
  bool allow_several_components = false;
};

/// Reads, scales to metres and checks a mesh: VTK legacy, VTU or Gmsh, told apart by content.
/// Throws Error: file-not-found, file-unreadable, unknown-format, what the readers throw
/// (read_vtk_legacy(), read_vtu(), read_gmsh()) and what check() throws.
/// @param path the file.
/// @param options unit and what to let pass.
Mesh read_mesh(const std::filesystem::path& path, const ReadOptions& options = {});

/// As read_mesh() without reordering and checks, so that a defective mesh can be described.
/// @param path the file.
/// @param options unit; the rest is not used.
Mesh read_mesh_unchecked(const std::filesystem::path& path, const ReadOptions& options = {});

/// As read_mesh_unchecked() from memory; lengths stay in file units.
/// @param bytes the whole file.
/// @param name its name, for messages.
Mesh parse_mesh(std::string_view bytes, const std::string& name);

}  // namespace sinew::mesh
