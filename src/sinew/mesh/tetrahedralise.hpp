/// @file
/// From a closed surface to a volume mesh, by the separate program Gmsh.
#pragma once

#include <filesystem>
#include <string>

#include "sinew/mesh/mesh.hpp"
#include "sinew/mesh/surface.hpp"

namespace sinew::mesh {

/// How to fill a surface.
struct TetrahedraliseOptions {
  double size = 0.005;           ///< m, wanted edge length
  SurfaceOptions surface;        ///< unit of the surface file
  double feature_angle = 40.0;   ///< degrees: sharper edges are kept
  std::string program = "gmsh";  ///< name or path
};

/// Fills a closed surface (STL, OBJ, PLY) with tetrahedra of about the wanted size, remeshing the
/// surface too, and writes the checked mesh as VTU in m when `out` is not empty. Gmsh is run as a
/// program of its own (its licence is the GPL; nothing of it is linked).
/// Throws Error: tool-missing saying how to install Gmsh, tool-failed with Gmsh's last lines,
/// out-of-range for a size that is not positive or would give more than 20 million elements,
/// surface-not-closed, and what read_surface(), check() and write_vtu() throw.
/// @param surface_file the surface.
/// @param out the VTU file to write, or empty.
/// @param options size, unit and program.
Mesh tetrahedralise_surface(const std::filesystem::path& surface_file,
                            const std::filesystem::path& out, const TetrahedraliseOptions& options);

}  // namespace sinew::mesh
