/// @file
/// Triangle surfaces: reading STL, OBJ and PLY, and checking that they are closed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Options for reading a surface file.
struct SurfaceOptions {
  double unit = 1.0;             ///< m per file unit
  bool unit_given = false;       ///< the user gave the unit: accept any size
  double weld_tolerance = 1e-6;  ///< relative to the diagonal: nearer vertices are merged
};

/// Reads a surface from STL (text or binary), OBJ or PLY; the ending of the file name tells the
/// format. Polygons are split into triangles, coincident vertices are merged, and triangles that
/// thereby become flat are removed. Coordinates have single precision. Throws Error:
/// file-not-found, file-unreadable, unknown-format, malformed-file, truncated-file, size-limit and
/// index-out-of-range (PLY), unsupported-element (a polygon that no fan of triangles fills),
/// non-finite-node, empty-list for a file without triangles, suspicious-unit.
/// @param path the file.
/// @param options unit and tolerance.
Surface read_surface(const std::filesystem::path& path, const SurfaceOptions& options = {});

/// Like read_surface(), from memory, in file units and without a check of the size.
/// @param bytes the whole file.
/// @param extension "stl", "obj" or "ply".
/// @param name its name, for messages.
/// @param weld_tolerance as in SurfaceOptions.
Surface parse_surface(std::string_view bytes, const std::string& extension, const std::string& name,
                      double weld_tolerance = 1e-6);

/// Throws Error(surface-not-closed), with the first such edge and their number, unless every edge
/// belongs to exactly two triangles, in opposite directions.
/// @param surface to check.
void require_closed(const Surface& surface);

/// Formats a surface as binary STL, for other programs.
/// @param surface to write.
/// @param scale factor on the coordinates: 1000 for mm.
std::string format_stl(const Surface& surface, double scale = 1.0);

}  // namespace sinew::mesh
