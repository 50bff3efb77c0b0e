// sinew mesh: makes a volume mesh from a closed surface or a built-in shape.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sinew/mesh/refine.hpp"
#include "sinew/mesh/report.hpp"
#include "sinew/mesh/tetrahedralise.hpp"
#include "sinew/mesh/write_mesh.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"

#include "arguments.hpp"
#include "commands.hpp"

namespace sinew::cli {

namespace {

constexpr int kMaxRefinements = 4;

struct MeshOptions {
  std::string surface, shape, out;
  std::vector<std::string> measures;  // "radius=15mm"
  std::optional<std::string> size, unit;
  std::string gmsh = "gmsh";
  int refine = 0;
};

mesh::Mesh from_shape(const MeshOptions& options) {
  if (options.unit) {
    throw Error(ErrorKind::bad_argument, {.item = "--unit"}, "shapes have no file unit",
                "give --unit only with a surface file");
  }
  scene::MeshDescription description = scene::read_shape(options.shape, options.measures);
  if (options.size) {
    description.parameters["element_size"] =
        positive_quantity("--size", *options.size, dimension::kLength);
  }
  return scene::make_mesh(description);
}

mesh::Mesh from_surface(const MeshOptions& options) {
  if (!options.measures.empty()) {
    throw Error(ErrorKind::bad_argument, {.item = "--set"},
                "a surface file has no dimensions to set", "give --set only with --shape");
  }
  mesh::TetrahedraliseOptions settings;
  settings.program = options.gmsh;
  if (!options.size) {
    throw Error(ErrorKind::bad_argument, {.item = "--size"}, "the target edge length is missing",
                "write for example --size 5mm");
  }
  settings.size = positive_quantity("--size", *options.size, dimension::kLength);
  if (options.unit) {
    settings.surface.unit = length_unit("--unit", *options.unit);
    settings.surface.unit_given = true;
  }
  return mesh::tetrahedralise_surface(options.surface, {}, settings);
}

int make(const MeshOptions& options) {
  if (options.surface.empty() == options.shape.empty()) {
    throw Error(
        ErrorKind::bad_argument, {.item = "mesh"},
        options.surface.empty() ? "neither a surface nor a shape is given"
                                : "both a surface and a shape are given",
        fmt::format("give a surface file or --shape {}", fmt::join(scene::shape_names(), "|")));
  }
  mesh::require_writable_format(options.out);
  require_range("--refine", options.refine, 0, kMaxRefinements);
  mesh::Mesh mesh = options.shape.empty() ? from_surface(options) : from_shape(options);
  for (int i = 0; i < options.refine; ++i) mesh = mesh::refine(mesh);
  mesh::write_mesh(options.out, mesh);
  fmt::print("{}wrote {}, lengths in m\n", mesh::format_report(mesh::describe(mesh)), options.out);
  return 0;
}

}  // namespace

void add_mesh(CommandLine& line) {
  Command command = line.add_command(
      "mesh", "Mesh a closed surface with tetrahedra, or create a primitive shape");
  const auto options = std::make_shared<MeshOptions>();
  command.add_option("SURFACE", options->surface, "Closed surface: STL, OBJ or PLY file");
  command
      .add_option("--shape", options->shape,
                  fmt::format("Create a shape instead: {}", fmt::join(scene::shape_names(), ", ")))
      .type_name("SHAPE");
  command
      .add_option("--set", options->measures,
                  "Dimension of the shape, named as in scenes, e.g. radius=15mm (repeatable)")
      .type_name("KEY=VALUE")
      .allow_extra_args(false);
  command
      .add_option("-o,--out", options->out, "Output file: .vtu, .vtk, or .stl for the surface only")
      .required()
      .type_name("FILE");
  command
      .add_option("--size", options->size, "Target edge length, e.g. 5mm; required for a surface")
      .type_name("LENGTH");
  command
      .add_option("--unit", options->unit, "Length unit of the surface file, e.g. mm (default: m)")
      .type_name("UNIT");
  command
      .add_option("--refine", options->refine,
                  "Split every tetrahedron into eight, N times (default: 0)")
      .type_name("N");
  command.add_option("--gmsh", options->gmsh, "Gmsh executable (default: gmsh)")
      .type_name("PROGRAM");
  command.footer(
      "Examples:\n"
      "  sinew mesh finger.stl --unit mm --size 5mm -o finger.vtu\n"
      "  sinew mesh --shape trunk -o trunk.vtu\n"
      "  sinew mesh --shape ribbed-finger --set length=120mm --set width=20mm --set height=18mm "
      "--size 3mm -o finger.vtu");
  command.set_action([options] { return make(*options); });
}

}  // namespace sinew::cli
