// Meshes of scenes: files, and the project's own shapes with cells of about the asked size.
#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

// Reads parameters by name, each with what it is when not given.
class Parameters {
 public:
  explicit Parameters(const MeshDescription& description) : values_(description.parameters) {}

  double get(const char* name, double otherwise) const {
    const auto found = values_.find(name);
    return found == values_.end() ? otherwise : found->second;
  }
  /// Cells of about element_size along a length; `otherwise` where no size is given.
  int cells(double length, int otherwise) const {
    const auto size = values_.find("element_size");
    if (size == values_.end()) return otherwise;
    return std::max(1, static_cast<int>(std::lround(length / size->second)));
  }

 private:
  const std::map<std::string, double>& values_;
};

// Cells through a length so that they are about as wide as those across `width` in `across` cells.
int matching(double length, double width, int across) {
  return std::max(1, static_cast<int>(std::lround(length / width * across)));
}

// A disc of hexahedra has two rings at least.
int rings(int asked, mesh::Cells cells) {
  return std::max(asked, cells == mesh::Cells::hexahedra ? 2 : 1);
}

mesh::Mesh make_block(const Parameters& p, mesh::Cells cells) {
  mesh::BlockShape shape;
  shape.size = {p.get("length", shape.size.x()), p.get("width", shape.size.y()),
                p.get("height", shape.size.z())};
  const double smallest = shape.size.minCoeff();
  for (int c = 0; c < 3; ++c) {
    shape.cells[static_cast<std::size_t>(c)] =
        p.cells(shape.size[c], matching(shape.size[c], smallest, 2));
  }
  return mesh::block(shape, cells);
}

mesh::Mesh make_cylinder(const Parameters& p, mesh::Cells cells) {
  mesh::CylinderShape shape;
  shape.radius = p.get("radius", shape.radius);
  shape.height = p.get("height", shape.height);
  shape.rings = rings(p.cells(shape.radius, 2), cells);
  shape.layers = p.cells(shape.height, matching(shape.height, shape.radius, shape.rings));
  return mesh::cylinder(shape, cells);
}

mesh::Mesh make_cone(const Parameters& p, mesh::Cells cells) {
  mesh::ConeShape shape;
  shape.bottom_radius = p.get("base_radius", shape.bottom_radius);
  shape.top_radius = p.get("tip_radius", shape.top_radius);
  shape.height = p.get("height", shape.height);
  const double radius = 0.5 * (shape.bottom_radius + shape.top_radius);
  shape.rings = rings(p.cells(radius, 2), cells);
  shape.layers = p.cells(shape.height, matching(shape.height, radius, shape.rings));
  return mesh::cone(shape, cells);
}

mesh::Mesh make_tube(const Parameters& p, mesh::Cells cells) {
  mesh::HollowCylinderShape shape;
  shape.inner_radius = p.get("inner_radius", shape.inner_radius);
  shape.outer_radius = p.get("outer_radius", shape.outer_radius);
  shape.height = p.get("height", shape.height);
  const double wall = shape.outer_radius - shape.inner_radius;
  const double girth = M_PI * (shape.inner_radius + shape.outer_radius);
  shape.through = p.cells(wall, 2);
  shape.around = std::max(6, p.cells(girth, matching(girth, wall, shape.through) / 2));
  shape.layers = p.cells(shape.height, matching(shape.height, wall, shape.through) / 2);
  return mesh::hollow_cylinder(shape, cells);
}

mesh::Mesh make_chambered(const Parameters& p, mesh::Cells cells) {
  mesh::ChamberedCylinderShape shape;
  shape.radius = p.get("radius", shape.radius);
  shape.height = p.get("height", shape.height);
  shape.chamber_radius = p.get("chamber_radius", shape.chamber_radius);
  shape.chamber_offset = p.get("chamber_offset", 0.0);
  shape.chamber_bottom = p.get("chamber_bottom", 0.0);
  shape.chamber_top = p.get("chamber_top", shape.height);
  shape.core = std::max(2, p.cells(2.0 * shape.chamber_radius, shape.core));
  shape.through = std::max(2, p.cells(shape.radius - shape.chamber_radius, shape.through));
  shape.layers = p.cells(shape.height, matching(shape.height, shape.chamber_radius, 1) * 3 / 2);
  return mesh::chambered_cylinder(shape, cells);
}

mesh::Mesh make_trunk(const Parameters& p, mesh::Cells cells) {
  mesh::TrunkShape shape;
  shape.bottom_radius = p.get("base_radius", shape.bottom_radius);
  shape.top_radius = p.get("tip_radius", shape.top_radius);
  shape.height = p.get("height", shape.height);
  shape.bellows = static_cast<int>(p.get("bellows", shape.bellows));
  shape.groove_depth =
      p.get("bellow_depth", shape.groove_depth * shape.bottom_radius) / shape.bottom_radius;
  const double radius = 0.5 * (shape.bottom_radius + shape.top_radius);
  shape.rings = rings(p.cells(radius, shape.rings), cells);
  const double bellow = shape.height / shape.bellows;
  shape.layers_per_bellow = 2 * std::max(1, (p.cells(bellow, shape.layers_per_bellow) + 1) / 2);
  return mesh::trunk(shape, cells);
}

mesh::Mesh make_shape(const MeshDescription& description, mesh::Cells cells) {
  const Parameters parameters(description);
  if (description.shape == "block") return make_block(parameters, cells);
  if (description.shape == "cylinder") return make_cylinder(parameters, cells);
  if (description.shape == "cone") return make_cone(parameters, cells);
  if (description.shape == "hollow-cylinder") return make_tube(parameters, cells);
  if (description.shape == "chambered-cylinder") return make_chambered(parameters, cells);
  if (description.shape == "trunk") return make_trunk(parameters, cells);
  throw Error(ErrorKind::unknown_choice, description.place,
              fmt::format("there is no shape '{}'", description.shape),
              "block, cylinder, cone, hollow-cylinder, chambered-cylinder or trunk");
}

mesh::Cells cells_of(Element element) {
  if (element == Element::hex8) return mesh::Cells::hexahedra;
  return element == Element::tet10 ? mesh::Cells::quadratic : mesh::Cells::tetrahedra;
}

bool holds_surface(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".stl" || ending == ".obj" || ending == ".ply";
}

}  // namespace

mesh::Surface make_surface(const MeshDescription& description) {
  return at_place(description.place, [&] {
    if (holds_surface(description.file)) {
      return mesh::read_surface(description.file,
                                {.unit = description.unit, .unit_given = description.unit_given});
    }
    const mesh::ReadOptions options{.unit = description.unit, .unit_given = description.unit_given};
    mesh::Mesh mesh = mesh::read_mesh_unchecked(description.file, options);
    const bool hollow = mesh.tetrahedra.empty() && mesh.hexahedra.empty();
    if (!hollow) mesh = mesh::read_mesh(description.file, options);
    return mesh::boundary_surface(mesh);
  });
}

mesh::Mesh make_mesh(const MeshDescription& description, Element element) {
  try {
    if (!description.shape.empty()) return make_shape(description, cells_of(element));
    mesh::ReadOptions options;
    options.unit = description.unit;
    options.unit_given = description.unit_place.line > 0 || description.unit != 1.0;
    mesh::Mesh mesh = mesh::read_mesh(description.file, options);
    return element == Element::tet10 ? mesh::with_middle_nodes(mesh) : mesh;
  } catch (const Error& error) {
    throw error.at(description.place);
  }
}

}  // namespace sinew::scene
