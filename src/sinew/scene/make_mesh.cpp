// Makes meshes of scenes: reads files, and generates built-in shapes with cells of about a given
// size.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

#include "sinew/core/whole.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/scale.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

constexpr int kMostCells = 1000000;  // more than any shape accepts, so that it names its limit

// Reads parameters by name, with defaults.
class Parameters {
 public:
  explicit Parameters(const MeshDescription& description) : values_(description.parameters) {}

  double get(const char* name, double otherwise) const {
    const auto found = values_.find(name);
    return found == values_.end() ? otherwise : found->second;
  }
  /// Number of cells of about element_size along a length; `otherwise` if no size is given.
  int cells(double length, int otherwise) const {
    const auto size = values_.find("element_size");
    if (size == values_.end()) return otherwise;
    return whole<int>(std::round(length / size->second), 1, kMostCells);
  }

 private:
  const std::map<std::string, double>& values_;
};

// Number of cells along a length such that they are about as large as `across` cells along `width`.
int matching(double length, double width, int across) {
  return whole<int>(std::round(length / width * across), 1, kMostCells);
}

// Number of rings of a disc; at least two for hexahedra.
int rings(int asked, mesh::Cells cells) {
  return std::max(asked, cells == mesh::Cells::hexahedra ? 2 : 1);
}

// Blocks of tetrahedra are symmetric if they have an even number of cells along each axis. An odd
// number is raised, so that a body bends in the plane of its load and nowhere else.
int symmetric(int count, mesh::Cells cells) {
  return cells == mesh::Cells::hexahedra ? count : count + count % 2;
}

mesh::Mesh make_block(const Parameters& p, mesh::Cells cells) {
  mesh::BlockShape shape;
  shape.size = {p.get("length", shape.size.x()), p.get("width", shape.size.y()),
                p.get("height", shape.size.z())};
  const double smallest = shape.size.minCoeff();
  for (int c = 0; c < 3; ++c) {
    const int count = p.cells(shape.size[c], matching(shape.size[c], smallest, 2));
    shape.cells[static_cast<std::size_t>(c)] = symmetric(count, cells);
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

mesh::Mesh make_sphere(const Parameters& p, mesh::Cells cells) {
  mesh::SphereShape shape;
  shape.radius = p.get("radius", shape.radius);
  shape.rings = rings(p.cells(shape.radius, shape.rings), cells);
  return mesh::sphere(shape, cells);
}

mesh::Mesh make_capsule(const Parameters& p, mesh::Cells cells) {
  mesh::CapsuleShape shape;
  shape.radius = p.get("radius", shape.radius);
  shape.length = p.get("length", shape.length);
  shape.rings = rings(p.cells(shape.radius, shape.rings), cells);
  shape.layers = p.cells(shape.length, matching(shape.length, shape.radius, shape.rings));
  return mesh::capsule(shape, cells);
}

// By default, ribs are twice as long as gaps, and the spine is a third of the height.
mesh::Mesh make_finger(const Parameters& p, mesh::Cells cells) {
  mesh::RibbedFingerShape shape;
  shape.size = {p.get("length", shape.size.x()), p.get("width", shape.size.y()),
                p.get("height", shape.size.z())};
  shape.ribs = static_cast<int>(p.get("ribs", shape.ribs));
  shape.gap = p.get("gap", shape.size.x() / (3 * shape.ribs - 1));
  shape.spine = p.get("spine", shape.size.z() / 3.0);
  const double rib = (shape.size.x() - (shape.ribs - 1) * shape.gap) / shape.ribs;
  const double rise = shape.size.z() - shape.spine, cell = std::min(shape.spine, shape.gap);
  shape.rib_cells = p.cells(rib, matching(rib, cell, 1));
  shape.gap_cells = p.cells(shape.gap, matching(shape.gap, cell, 1));
  // The number of cells along the finger, n ribs + (n - 1) gaps, becomes even.
  int& middle = shape.ribs % 2 == 0 ? shape.gap_cells : shape.rib_cells;
  middle = symmetric(middle, cells);
  shape.width_cells = symmetric(p.cells(shape.size.y(), matching(shape.size.y(), cell, 1)), cells);
  shape.spine_cells = p.cells(shape.spine, matching(shape.spine, cell, 1));
  shape.rib_rise_cells = p.cells(rise, matching(rise, cell, 1));
  return mesh::ribbed_finger(shape, cells);
}

mesh::Mesh make_shape(const MeshDescription& description, mesh::Cells cells) {
  using Maker = mesh::Mesh (*)(const Parameters&, mesh::Cells);
  static const std::map<std::string, Maker> makers = {{"block", make_block},
                                                      {"cylinder", make_cylinder},
                                                      {"cone", make_cone},
                                                      {"hollow-cylinder", make_tube},
                                                      {"chambered-cylinder", make_chambered},
                                                      {"sphere", make_sphere},
                                                      {"capsule", make_capsule},
                                                      {"ribbed-finger", make_finger},
                                                      {"trunk", make_trunk}};
  return makers.at(description.shape)(Parameters(description), cells);
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

mesh::Surface read_surface_of(const MeshDescription& description) {
  if (holds_surface(description.file)) {
    return mesh::read_surface(description.file,
                              {.unit = description.unit, .unit_given = description.unit_given});
  }
  const mesh::ReadOptions options{.unit = description.unit, .unit_given = description.unit_given};
  mesh::Mesh mesh = mesh::read_mesh_unchecked(description.file, options);
  const bool hollow = mesh.tetrahedra.empty() && mesh.hexahedra.empty();
  if (!hollow) mesh = mesh::read_mesh(description.file, options);
  return mesh::boundary_surface(mesh);
}

}  // namespace

mesh::Surface make_surface(const MeshDescription& description) {
  return at_place(description.place, [&] {
    mesh::Surface surface = read_surface_of(description);
    mesh::scale(surface, description.scale);
    return surface;
  });
}

mesh::Mesh make_mesh(const MeshDescription& description, Element element) {
  try {
    if (!description.shape.empty()) return make_shape(description, cells_of(element));
    mesh::ReadOptions options;
    options.unit = description.unit;
    options.unit_given = description.unit_place.line > 0 || description.unit != 1.0;
    mesh::Mesh mesh = mesh::read_mesh(description.file, options);
    mesh::scale(mesh, description.scale);
    return element == Element::tet10 ? mesh::with_middle_nodes(mesh) : mesh;
  } catch (const Error& error) {
    throw error.at(description.place);
  }
}

}  // namespace sinew::scene
