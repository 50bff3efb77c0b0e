// sinew mesh: a volume mesh from a closed surface, or one of our own shapes.
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
    throw Error(ErrorKind::bad_argument, {.item = "--unit"}, "a shape has no unit of its own",
                "give --unit with a surface file only");
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
    throw Error(ErrorKind::bad_argument, {.item = "--set"}, "a surface file has no measures to set",
                "give --set with --shape only");
  }
  mesh::TetrahedraliseOptions settings;
  settings.program = options.gmsh;
  if (!options.size) {
    throw Error(ErrorKind::bad_argument, {.item = "--size"}, "the wanted edge length is missing",
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
        options.surface.empty() ? "there is nothing to mesh" : "there are two things to mesh",
        fmt::format("give a surface file or --shape {}", fmt::join(scene::shape_names(), "|")));
  }
  mesh::require_writable_format(options.out);
  require_range("--refine", options.refine, 0, kMaxRefinements);
  mesh::Mesh mesh = options.shape.empty() ? from_surface(options) : from_shape(options);
  for (int i = 0; i < options.refine; ++i) mesh = mesh::refine(mesh);
  mesh::write_mesh(options.out, mesh);
  fmt::print("{}written to {}, lengths in m\n", mesh::format_report(mesh::describe(mesh)),
             options.out);
  return 0;
}

}  // namespace

void add_mesh(CommandLine& line) {
  Command command = line.add_command("mesh", "Fill a surface with tetrahedra, or make a shape");
  const auto options = std::make_shared<MeshOptions>();
  command.add_option("SURFACE", options->surface, "Closed surface: STL, OBJ or PLY");
  command
      .add_option("--shape", options->shape,
                  fmt::format("Make a shape instead: {}", fmt::join(scene::shape_names(), ", ")))
      .type_name("SHAPE");
  command
      .add_option("--set", options->measures,
                  "Set a measure of the shape, as scenes name it: radius=15mm; may be repeated")
      .type_name("KEY=VALUE")
      .allow_extra_args(false);
  command
      .add_option("-o,--out", options->out,
                  "File to write: .vtu, .vtk, or .stl for the surface alone")
      .required()
      .type_name("FILE");
  command.add_option("--size", options->size, "Wanted edge length: 5mm").type_name("LENGTH");
  command.add_option("--unit", options->unit, "Unit of the surface file: mm").type_name("UNIT");
  command.add_option("--refine", options->refine, "Cut every tetrahedron in eight, N times")
      .type_name("N");
  command.add_option("--gmsh", options->gmsh, "The Gmsh program that fills surfaces")
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
