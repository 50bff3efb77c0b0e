/// @file
/// Volume meshing of a closed surface by the external program Gmsh.
#pragma once

#include <filesystem>
#include <string>

#include "sinew/mesh/mesh.hpp"
#include "sinew/mesh/surface.hpp"

namespace sinew::mesh {

/// Options for volume meshing.
struct TetrahedraliseOptions {
  double size = 0.005;           ///< m, target edge length
  SurfaceOptions surface;        ///< unit of the surface file
  double feature_angle = 40.0;   ///< degrees; sharper edges are kept
  std::string program = "gmsh";  ///< name or path
};

/// Fills a closed surface (STL, OBJ, PLY) with tetrahedra of about the target size. The surface is
/// remeshed, too. The checked mesh is written as VTU in m unless `out` is empty. Gmsh runs as a
/// separate program (its licence is the GPL; it is not linked). Throws Error: tool-missing with how
/// to install Gmsh, tool-failed with the last lines of Gmsh, out-of-range for a size that is not
/// positive or would give more than 20 million elements, surface-not-closed, and the errors of
/// read_surface(), read_gmsh(), check() and write_vtu().
/// @param surface_file the surface.
/// @param out the VTU file to write, or empty.
/// @param options size, unit and program.
Mesh tetrahedralise_surface(const std::filesystem::path& surface_file,
                            const std::filesystem::path& out, const TetrahedraliseOptions& options);

}  // namespace sinew::mesh
