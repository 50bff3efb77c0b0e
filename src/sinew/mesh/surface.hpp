/// @file
/// Triangle surfaces: read from STL, OBJ and PLY, checked for being closed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// How to take a surface file.
struct SurfaceOptions {
  double unit = 1.0;             ///< m per file unit
  bool unit_given = false;       ///< the unit was chosen by someone, so that any size is believed
  double weld_tolerance = 1e-6;  ///< of the diagonal: nearer vertices become one
};

/// Reads STL (text and binary), OBJ or PLY, told apart by the file name. Polygons are cut into
/// triangles; vertices at the same place are welded; triangles that welding makes flat are left
/// out. Files hold single precision. Throws Error: file-not-found, file-unreadable, unknown-format,
/// malformed-file, non-finite-node, empty-list for a file without triangles, suspicious-unit.
/// @param path the file.
/// @param options unit and tolerance.
Surface read_surface(const std::filesystem::path& path, const SurfaceOptions& options = {});

/// As read_surface() from memory, in file units and unchecked for size.
/// @param bytes the whole file.
/// @param extension "stl", "obj" or "ply".
/// @param name its name, for messages.
/// @param weld_tolerance as in SurfaceOptions.
Surface parse_surface(std::string_view bytes, const std::string& extension, const std::string& name,
                      double weld_tolerance = 1e-6);

/// Throws Error(surface-not-closed), naming an edge and how many there are, unless every edge has
/// exactly two triangles that run along it in opposite directions.
/// @param surface to check.
void require_closed(const Surface& surface);

/// The surface as binary STL, for other programs.
/// @param surface to write.
/// @param scale multiplies the coordinates: 1000 writes mm.
std::string format_stl(const Surface& surface, double scale = 1.0);

}  // namespace sinew::mesh
