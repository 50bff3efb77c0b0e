#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/quantity.hpp"
#include "sinew/mesh/refine.hpp"
#include "sinew/mesh/report.hpp"
#include "sinew/mesh/tetrahedralise.hpp"
#include "sinew/mesh/write.hpp"
#include "sinew/scene/build.hpp"

#include "commands.hpp"

namespace sinew::cli {

int mesh(const MeshOptions& options) {
  const double size =
      parse_quantity(options.size, dimension::kLength, {.file = {}, .item = "--size"});
  sinew::mesh::Mesh result;
  if (!options.shape.empty()) {
    scene::MeshDescription description;
    description.shape = options.shape;
    description.place.item = "--shape";
    description.parameters["element_size"] = size;
    result = scene::make_mesh(description);
  } else if (!options.input.empty()) {
    sinew::mesh::TetrahedraliseOptions settings;
    settings.size = size;
    if (!options.unit.empty()) {
      settings.surface.unit =
          parse_unit(options.unit, dimension::kLength, {.file = {}, .item = "--unit"});
      settings.surface.unit_given = true;
    }
    result = sinew::mesh::tetrahedralise_surface(options.input, {}, settings);
  } else {
    throw Error(ErrorKind::bad_argument, {.file = {}, .item = "mesh"},
                "there is neither a surface file nor a shape",
                "write `sinew mesh part.stl -o part.vtu --size 5mm`");
  }
  for (int i = 0; i < options.refine; ++i) result = sinew::mesh::refine(result);
  sinew::mesh::write_vtu(options.output, result);
  fmt::print("{}", sinew::mesh::format_report(sinew::mesh::describe(result)));
  fmt::print("written to {} (lengths in m)\n", options.output);
  return 0;
}

}  // namespace sinew::cli
