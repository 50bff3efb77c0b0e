#include "sinew/mesh/tetrahedralise.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/core/process.hpp"
#include "sinew/mesh/check.hpp"
#include "sinew/mesh/gmsh.hpp"
#include "sinew/mesh/solid.hpp"
#include "sinew/mesh/write.hpp"

namespace sinew::mesh {

namespace {

/// Gmsh gets lengths in millimetres, since its absolute tolerances suit numbers near one.
constexpr double kGmshUnit = 1e-3;
constexpr double kMaxElements = 20e6;

/// A temporary folder that is removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "sinew-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw Error(ErrorKind::file_unwritable, {.file = name},
                  fmt::format("no temporary folder can be made: {}", std::strerror(errno)),
                  "set TMPDIR to a folder that may be written to");
    }
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void check_options(const Surface& surface, const TetrahedraliseOptions& options) {
  const double volume = std::abs(solid_moments(surface).volume);
  // A regular tetrahedron of edge h has the volume h^3 / 8.5.
  const double elements = 8.5 * volume / std::pow(options.size, 3);
  if (!(options.size > 0.0) || !std::isfinite(options.size) || elements > kMaxElements) {
    throw Error(ErrorKind::out_of_range, {.item = "size"},
                options.size > 0.0
                    ? fmt::format("{} m would give about {:.1e} tetrahedra", options.size, elements)
                    : fmt::format("{} m is not an edge length", options.size),
                fmt::format("choose about {:.2g} m, which gives about 3000",
                            std::cbrt(8.5 * volume / 3000.0)));
  }
}

/// Gmsh script: reparametrises the triangulation, so that the surface is remeshed, and fills it.
std::string script(const std::filesystem::path& surface, const TetrahedraliseOptions& options) {
  const double size = options.size / kGmshUnit;
  return fmt::format(
      "Merge \"{}\";\n"
      "ClassifySurfaces{{{} * Pi / 180, 1, 1, Pi}};\n"
      "CreateGeometry;\n"
      "Surface Loop(1) = Surface{{:}};\n"
      "Volume(1) = {{1}};\n"
      "Mesh.MeshSizeMin = {};\n"
      "Mesh.MeshSizeMax = {};\n"
      "Mesh.MeshSizeExtendFromBoundary = 0;\n"
      "Mesh.Optimize = 1;\n"
      "Mesh.ElementOrder = 1;\n"
      "Mesh.SaveAll = 1;\n",
      surface.string(), options.feature_angle, size, size);
}

Mesh run_gmsh(const Surface& surface, const TetrahedraliseOptions& options) {
  const TemporaryFolder folder;
  const auto stl = folder.path() / "surface.stl", geo = folder.path() / "volume.geo",
             msh = folder.path() / "volume.msh";
  write_file(stl, format_stl(surface, 1.0 / kGmshUnit));
  write_file(geo, script(stl, options));
  const ProcessResult result = run_program({options.program, geo.string(), "-3", "-format", "msh41",
                                            "-bin", "-nt", "1", "-o", msh.string()});
  std::error_code ignored;
  if (result.exit_code != 0 || !std::filesystem::exists(msh, ignored)) {
    throw Error(ErrorKind::tool_failed, {.file = surface.name},
                fmt::format("Gmsh ended with code {} and these last lines:\n{}\n", result.exit_code,
                            last_lines(result.output, 8)),
                "repair the surface (self-intersections, slivers) or change --size");
  }
  Mesh mesh = read_gmsh(read_file(msh), surface.name);
  mesh.nodes *= kGmshUnit;
  return mesh;
}

}  // namespace

Mesh tetrahedralise_surface(const std::filesystem::path& surface_file,
                            const std::filesystem::path& out,
                            const TetrahedraliseOptions& options) {
  const Surface surface = read_surface(surface_file, options.surface);
  require_closed(surface);
  check_options(surface, options);
  if (!program_exists(options.program)) {
    throw Error(ErrorKind::tool_missing, {.item = options.program},
                "filling a surface with tetrahedra needs the program Gmsh, which is not installed",
                "install it with `apt-get install gmsh`");
  }
  Mesh mesh = run_gmsh(surface, options);
  mesh.notes = {.format = "surface, meshed by Gmsh", .unit = options.surface.unit};
  check(mesh, {.allow_several_components = true, .unit_given = true});
  if (!out.empty()) write_vtu(out, mesh);
  return mesh;
}

}  // namespace sinew::mesh
