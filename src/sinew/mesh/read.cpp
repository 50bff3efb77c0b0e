#include "sinew/mesh/read.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/mesh/check.hpp"
#include "sinew/mesh/gmsh.hpp"
#include "sinew/mesh/vtk_legacy.hpp"
#include "sinew/mesh/vtu.hpp"

namespace sinew::mesh {

namespace {

void scale(Mesh& mesh, double unit) {
  if (!std::isfinite(unit) || unit <= 0.0) {
    throw Error(ErrorKind::out_of_range, {.file = mesh.name},
                fmt::format("a unit of {} m makes no sense", unit), "give a positive length");
  }
  mesh.nodes *= unit;
  mesh.notes.unit = unit;
}

bool is_surface_name(std::string_view name) {
  return name.ends_with(".stl") || name.ends_with(".obj") || name.ends_with(".ply");
}

}  // namespace

Mesh parse_mesh(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("# vtk DataFile")) return read_vtk_legacy(bytes, name);
  if (bytes.starts_with("$MeshFormat") || bytes.starts_with("$Comments")) {
    return read_gmsh(bytes, name);
  }
  if (bytes.substr(0, 4096).find("<VTKFile") != std::string_view::npos) {
    return read_vtu(bytes, name);
  }
  if (bytes.empty()) {
    throw Error(ErrorKind::truncated_file, {.file = name}, "the file is empty",
                "write it again from the program that made it");
  }
  if (is_surface_name(name)) {
    throw Error(ErrorKind::no_volume_elements, {.file = name},
                "this is a surface, and a body needs tetrahedra",
                fmt::format("fill it: sinew mesh {} -o FILE.vtu --size 5mm", name));
  }
  throw Error(ErrorKind::unknown_format, {.file = name},
              "this is none of the mesh formats that are read",
              "give a VTK legacy (.vtk), VTU (.vtu) or Gmsh (.msh, version 2.2 or 4.1) file");
}

Mesh read_mesh_unchecked(const std::filesystem::path& path, const ReadOptions& options) {
  Mesh mesh = parse_mesh(read_file(path), path.string());
  scale(mesh, options.unit);
  return mesh;
}

Mesh read_mesh(const std::filesystem::path& path, const ReadOptions& options) {
  Mesh mesh = read_mesh_unchecked(path, options);
  check(mesh, {.allow_several_components = options.allow_several_components,
               .unit_given = options.unit_given || options.unit != 1.0});
  return mesh;
}

}  // namespace sinew::mesh
