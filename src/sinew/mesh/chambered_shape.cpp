// A solid cylinder with a chamber beside its axis.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/whole.hpp"
#include "sinew/mesh/shape_cells.hpp"
#include "sinew/mesh/shape_checks.hpp"
#include "sinew/mesh/sweep.hpp"

namespace sinew::mesh {

namespace {

constexpr int kMostLayers = 2000;

/// The circle of the chamber as an O-grid, and rings from it to the outer circle, with linearly
/// interpolated centres and radii. Radii are in m. `wall` and `outside` list the nodes on the
/// chamber wall and on the outer circle.
struct EccentricSection {
  Section section;
  std::vector<NodeId> wall, outside;
  NodeId core_nodes = 0;  // number of nodes before those of the wall
};

EccentricSection eccentric_section(const ChamberedCylinderShape& shape, Cells cells) {
  EccentricSection result;
  Section& section = result.section;
  const Section core = disc_section_of_quadrilaterals(shape.core);
  section.quadrilaterals = core.quadrilaterals;
  const double round = rounding(outside_corners(core), cells);
  const double wall_radius = round * shape.chamber_radius, outer_radius = round * shape.radius;
  const auto add = [&](double x, double y) {
    section.radius.push_back(std::hypot(x, y));
    section.angle.push_back(std::atan2(y, x));
    return static_cast<NodeId>(section.radius.size()) - 1;
  };
  std::vector<double> turn;  // angle of each node of the wall, rad
  for (std::size_t i = 0; i < core.radius.size(); ++i) {
    const double r = wall_radius * core.radius[i];
    const NodeId node =
        add(shape.chamber_offset + r * std::cos(core.angle[i]), r * std::sin(core.angle[i]));
    if (core.radius[i] == 1.0) {
      result.wall.push_back(node);
      turn.push_back(core.angle[i]);
    }
  }
  result.core_nodes = result.wall.front();
  std::vector<NodeId> ring = result.wall;
  for (int k = 1; k <= shape.through; ++k) {
    const double part = static_cast<double>(k) / shape.through;
    const double centre = (1.0 - part) * shape.chamber_offset;
    const double radius = std::lerp(wall_radius, outer_radius, part);
    std::vector<NodeId> next;
    next.reserve(turn.size());
    for (const double angle : turn) {
      next.push_back(add(centre + radius * std::cos(angle), radius * std::sin(angle)));
    }
    for (std::size_t a = 0; a < ring.size(); ++a) {
      const std::size_t b = (a + 1) % ring.size();
      section.quadrilaterals.push_back({ring[a], next[a], next[b], ring[b]});
    }
    ring = std::move(next);
  }
  result.outside = ring;
  return result;
}

/// Heights of layers: equal ones below, along and above the chamber.
std::vector<double> chamber_heights(const ChamberedCylinderShape& shape) {
  const double size = shape.height / shape.layers;
  std::vector<double> heights{0.0};
  for (const double end : {shape.chamber_bottom, shape.chamber_top, shape.height}) {
    const double begin = heights.back();
    if (end <= begin) continue;
    const int layers = whole<int>(std::round((end - begin) / size), 1, kMostLayers);
    for (int k = 1; k <= layers; ++k) heights.push_back(begin + (end - begin) * k / layers);
  }
  return heights;
}

void check_chamber(const ChamberedCylinderShape& shape, const std::string& name) {
  require_length(shape.radius, name, "radius");
  require_length(shape.height, name, "height");
  require_length(shape.chamber_radius, name, "chamber_radius");
  require(shape.chamber_offset >= 0.0 && shape.chamber_offset + shape.chamber_radius < shape.radius,
          name,
          fmt::format("chamber_offset = {} m and chamber_radius = {} m reach beyond radius = {} m",
                      shape.chamber_offset, shape.chamber_radius, shape.radius));
  require(shape.chamber_bottom >= 0.0 && shape.chamber_top > shape.chamber_bottom &&
              shape.chamber_top <= shape.height,
          name,
          fmt::format("the chamber reaches from {} to {} m of {} m", shape.chamber_bottom,
                      shape.chamber_top, shape.height));
  require_cells(shape.core, 2, name, "core");
  require_cells(shape.through, 1, name, "through");
  require_cells(shape.layers, 1, name, "layers");
}

// Splits the quadrilaterals of a section into triangles.
void split_cells(Section& section) {
  for (const auto& [a, b, c, d] : section.quadrilaterals) {
    section.triangles.push_back({a, b, c});
    section.triangles.push_back({a, c, d});
  }
  section.quadrilaterals.clear();
}

// Makes the solid cylinder and removes the chamber from it.
class Chambered {
 public:
  Chambered(const ChamberedCylinderShape& shape, Cells cells)
      : shape_(shape), plan_(eccentric_section(shape, cells)), heights_(chamber_heights(shape)) {
    if (cells != Cells::hexahedra) split_cells(plan_.section);
  }

  Mesh solid(const std::string& name) const {
    return sweep(
        plan_.section, heights_, [](double s, double) { return s; }, name);
  }

  // Removes the elements of the chamber: those with all nodes in its circle, between its ends.
  void cut(Mesh& mesh) const {
    const auto inside = [&](const auto& element) {
      double z = 0.0;
      bool core = true;
      for (const NodeId node : element) {
        core = core && in_layer(node) < wall_end();
        z += height(node) / static_cast<double>(element.size());
      }
      return core && z > shape_.chamber_bottom && z < shape_.chamber_top;
    };
    std::erase_if(mesh.tetrahedra, inside);
    std::erase_if(mesh.hexahedra, inside);
  }

  void add_sets(Mesh& mesh) const {
    const double tolerance = 1e-9 * shape_.height;
    for (NodeId node = 0; node < mesh.node_count(); ++node) {
      const double z = height(node);
      const NodeId at = in_layer(node);
      const bool along =
          z > shape_.chamber_bottom - tolerance && z < shape_.chamber_top + tolerance;
      const bool end = (z < shape_.chamber_bottom + tolerance && shape_.chamber_bottom > 0.0) ||
                       (z > shape_.chamber_top - tolerance && shape_.chamber_top < shape_.height);
      const bool on_wall = at >= plan_.core_nodes && at < wall_end();
      if (along && (on_wall || (end && at < plan_.core_nodes))) {
        mesh.node_sets["chamber"].push_back(node);
      }
      if (at >= plan_.outside.front()) mesh.node_sets["side"].push_back(node);
    }
  }

 private:
  NodeId layer_size() const { return static_cast<NodeId>(plan_.section.radius.size()); }
  NodeId in_layer(NodeId node) const { return node % layer_size(); }
  double height(NodeId node) const {
    return heights_[static_cast<std::size_t>(node / layer_size())];
  }
  NodeId wall_end() const { return plan_.core_nodes + static_cast<NodeId>(plan_.wall.size()); }

  const ChamberedCylinderShape& shape_;
  EccentricSection plan_;
  std::vector<double> heights_;
};

std::vector<Circle> circles_of(const ChamberedCylinderShape& shape) {
  std::vector<Circle> circles;
  for (int k = 0; k <= shape.through; ++k) {
    const double part = static_cast<double>(k) / shape.through;
    const double radius = std::lerp(shape.chamber_radius, shape.radius, part);
    circles.push_back({(1.0 - part) * shape.chamber_offset, [radius](double) { return radius; }});
  }
  return circles;
}

}  // namespace

Mesh chambered_cylinder(const ChamberedCylinderShape& shape, Cells cells) {
  const std::string name = "chambered cylinder";
  check_chamber(shape, name);
  const Chambered layers(shape, cells);
  Mesh mesh = layers.solid(name);
  layers.cut(mesh);
  layers.add_sets(mesh);
  drop_unused_nodes(mesh);
  return finished(std::move(mesh), cells, circles_of(shape));
}

}  // namespace sinew::mesh
