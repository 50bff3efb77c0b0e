// Solids whose layers are discs or rings around one axis.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/mesh/shape_cells.hpp"
#include "sinew/mesh/shape_checks.hpp"
#include "sinew/mesh/sweep.hpp"

namespace sinew::mesh {

namespace {

Section disc(int rings, Cells cells) {
  return cells == Cells::hexahedra ? disc_section_of_quadrilaterals(rings) : disc_section(rings);
}

/// The circles of all rings of a section around the axis.
std::vector<Circle> ring_circles(const Section& section, const RadialProfile& profile) {
  std::vector<double> radii = section.radius;
  std::ranges::sort(radii);
  radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
  std::vector<Circle> circles;
  for (const double s : radii) {
    if (s > 0.0) circles.push_back({0.0, [s, profile](double z) { return profile(s, z); }});
  }
  if (radii.front() == 0.0) return circles;
  circles.push_back({0.0, [profile](double z) { return profile(0.0, z); }});  // bore of a tube
  return circles;
}

std::vector<double> even_heights(double height, int layers) {
  std::vector<double> heights;
  for (int k = 0; k <= layers; ++k) heights.push_back(height * k / layers);
  return heights;
}

/// Adds the nodes of every layer whose section radius is `s` as a set.
void add_wall_set(Mesh& mesh, const Section& section, double s, const std::string& name) {
  const auto in_layer = static_cast<NodeId>(section.radius.size());
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    if (section.radius[static_cast<std::size_t>(node % in_layer)] == s) {
      mesh.node_sets[name].push_back(node);
    }
  }
}

}  // namespace

Mesh cylinder(const CylinderShape& shape, Cells cells) {
  require_length(shape.radius, "cylinder", "radius");
  Mesh mesh = cone({.bottom_radius = shape.radius,
                    .top_radius = shape.radius,
                    .height = shape.height,
                    .rings = shape.rings,
                    .layers = shape.layers},
                   cells);
  mesh.name = "cylinder";
  return mesh;
}

Mesh cone(const ConeShape& shape, Cells cells) {
  require_length(shape.bottom_radius, "cone", "bottom_radius");
  require_length(shape.top_radius, "cone", "top_radius");
  require_length(shape.height, "cone", "height");
  require_rings(shape.rings, cells, "cone");
  require_cells(shape.layers, 1, "cone", "layers");
  const Section section = disc(shape.rings, cells);
  const double round = rounding(outside_corners(section), cells);
  const auto profile = [&](double s, double z) {
    return round * s * std::lerp(shape.bottom_radius, shape.top_radius, z / shape.height);
  };
  Mesh mesh = sweep(section, even_heights(shape.height, shape.layers), profile, "cone");
  add_wall_set(mesh, section, 1.0, "side");
  return finished(std::move(mesh), cells, ring_circles(section, profile));
}

Mesh hollow_cylinder(const HollowCylinderShape& shape, Cells cells) {
  const std::string name = "hollow cylinder";
  require_length(shape.inner_radius, name, "inner_radius");
  require_length(shape.outer_radius, name, "outer_radius");
  require_length(shape.height, name, "height");
  require(shape.outer_radius > shape.inner_radius, name,
          fmt::format("outer_radius = {} m is not larger than inner_radius = {} m",
                      shape.outer_radius, shape.inner_radius));
  require_cells(shape.through, 1, name, "through");
  require_cells(shape.around, 3, name, "around");
  require_cells(shape.layers, 1, name, "layers");
  const Section section = annulus_section(shape.through, shape.around, cells != Cells::hexahedra);
  const double round = rounding(shape.around, cells);
  const auto profile = [&](double s, double) {
    return round * std::lerp(shape.inner_radius, shape.outer_radius, s);
  };
  Mesh mesh = sweep(section, even_heights(shape.height, shape.layers), profile, name);
  add_wall_set(mesh, section, 0.0, "inner");
  add_wall_set(mesh, section, 1.0, "outer");
  return finished(std::move(mesh), cells, ring_circles(section, profile));
}

Mesh trunk(const TrunkShape& shape, Cells cells) {
  require_length(shape.height, "trunk", "height");
  require_length(shape.bottom_radius, "trunk", "bottom_radius");
  require_length(shape.top_radius, "trunk", "top_radius");
  require(shape.groove_depth >= 0.0 && shape.groove_depth <= 0.6, "trunk",
          fmt::format("groove_depth = {} (from 0 to 0.6)", shape.groove_depth));
  require_cells(shape.bellows, 1, "trunk", "bellows");
  require_cells(shape.layers_per_bellow, 2, "trunk", "layers_per_bellow");
  require_rings(shape.rings, cells, "trunk");
  const Section section = disc(shape.rings, cells);
  // Crests are at both ends and between bellows. The wave decays towards the axis as s^3, so that
  // the inside stays smooth.
  const auto profile = [&](double s, double z) {
    const double crest = std::lerp(shape.bottom_radius, shape.top_radius, z / shape.height);
    const double phase = 2.0 * std::numbers::pi * shape.bellows * z / shape.height;
    return crest * (s - 0.5 * shape.groove_depth * (1.0 - std::cos(phase)) * s * s * s);
  };
  const int layers = shape.bellows * shape.layers_per_bellow;
  Mesh mesh = sweep(section, even_heights(shape.height, layers), profile, "trunk");
  add_wall_set(mesh, section, 1.0, "side");
  return finished(std::move(mesh), cells, {});
}

}  // namespace sinew::mesh
