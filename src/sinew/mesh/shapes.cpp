#include "sinew/mesh/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mesh/check.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/sweep.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

namespace {

void require(bool holds, const std::string& shape, const std::string& message) {
  if (!holds) {
    throw Error(
        ErrorKind::out_of_range, {.item = shape}, message,
        "give positive, finite lengths and an element size that they are not too large for");
  }
}

void require_length(double value, const std::string& shape, const char* what) {
  require(std::isfinite(value) && value > 0.0, shape, fmt::format("{} = {} m", what, value));
}

void require_cells(int value, int least, const std::string& shape, const char* what) {
  constexpr int kMaxCount = 2000;
  require(value >= least && value <= kMaxCount, shape,
          fmt::format("{} = {} (from {} to {})", what, value, least, kMaxCount));
}

void require_rings(int rings, Cells cells, const std::string& shape) {
  require_cells(rings, cells == Cells::hexahedra ? 2 : 1, shape, "rings");
}

Section disc(int rings, Cells cells) {
  return cells == Cells::hexahedra ? disc_section_of_quadrilaterals(rings) : disc_section(rings);
}

/// How much farther out than a circle the corners of a regular polygon lie that has its area, which
/// gives it nearly the same second moment as well: bending stiffness is right from few cells on.
double rounding(int corners, Cells cells) {
  if (cells == Cells::quadratic) return 1.0;
  const double angle = 2.0 * std::numbers::pi / corners;
  return std::sqrt(angle / std::sin(angle));
}

/// A circle about an axis along z that curves the edges between nodes on it.
struct Circle {
  double x = 0.0;                        // of the axis, at y = 0, m
  std::function<double(double)> radius;  // at a height, m
};

/// Least determinant of an element's map at its corners and points of integration, over that of its
/// corners alone.
double least_jacobian(const Mesh& mesh, const QuadraticTetrahedron& element) {
  Eigen::Matrix<double, 10, 3> x;
  for (std::size_t a = 0; a < 10; ++a) {
    x.row(static_cast<Eigen::Index>(a)) = mesh.nodes.row(element[a]);
  }
  const Matrix3 straight = (x.middleRows<3>(1).rowwise() - x.row(0)).transpose();
  double least = std::numeric_limits<double>::infinity();
  const auto see = [&](const std::array<double, 4>& point) {
    least = std::min(least, (x.transpose() * quadratic_gradients(point)).determinant());
  };
  for (const auto& point : quadratic_points()) see(point);
  for (std::size_t a = 0; a < 4; ++a) {
    std::array<double, 4> corner{};
    corner[a] = 1.0;
    see(corner);
  }
  return least / straight.determinant();
}

/// Where cells are flat beside their circle's curve, arcs would fold elements: these get straight
/// edges again.
void straighten_folded(Mesh& mesh) {
  constexpr double kMinJacobian = 0.1;
  for (bool folded = true; folded;) {
    folded = false;
    for (const QuadraticTetrahedron& element : mesh.quadratic) {
      if (least_jacobian(mesh, element) >= kMinJacobian) continue;
      folded = true;
      for (std::size_t e = 0; e < kEdges.size(); ++e) {
        mesh.nodes.row(element[4 + e]) =
            0.5 * (mesh.nodes.row(element[kEdges[e][0]]) + mesh.nodes.row(element[kEdges[e][1]]));
      }
    }
  }
}

/// The mesh as the cells ask: with middle nodes where they are quadratic, those of edges along a
/// circle on its arc.
Mesh finished(Mesh mesh, Cells cells, const std::vector<Circle>& circles) {
  if (cells != Cells::quadratic) return mesh;
  Mesh result = with_middle_nodes(mesh);
  constexpr double kOn = 1e-9;
  for (const QuadraticTetrahedron& element : result.quadratic) {
    for (std::size_t e = 0; e < kEdges.size(); ++e) {
      const Vector3 a = result.nodes.row(element[kEdges[e][0]]).transpose();
      const Vector3 b = result.nodes.row(element[kEdges[e][1]]).transpose();
      for (const Circle& circle : circles) {
        const Vector3 axis(circle.x, 0.0, 0.0);
        const Eigen::Vector2d p = (a - axis).head<2>(), q = (b - axis).head<2>();
        const double ra = circle.radius(a.z()), rb = circle.radius(b.z());
        const bool on = std::abs(p.norm() - ra) < kOn * ra && std::abs(q.norm() - rb) < kOn * rb;
        const Eigen::Vector2d middle = p.normalized() + q.normalized();
        if (!on || middle.norm() < 1.0) continue;  // a chord across is none along
        const double z = 0.5 * (a.z() + b.z());
        const Eigen::Vector2d at = circle.radius(z) * middle.normalized();
        result.nodes.row(element[4 + e]) << circle.x + at.x(), at.y(), z;
      }
    }
  }
  straighten_folded(result);
  return result;
}

/// The circles of all rings of a section round the axis.
std::vector<Circle> ring_circles(const Section& section, const RadialProfile& profile) {
  std::vector<double> radii = section.radius;
  std::ranges::sort(radii);
  radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
  std::vector<Circle> circles;
  for (const double s : radii) {
    if (s > 0.0) circles.push_back({0.0, [s, profile](double z) { return profile(s, z); }});
  }
  if (radii.front() == 0.0) return circles;
  circles.push_back({0.0, [profile](double z) { return profile(0.0, z); }});  // a tube's bore
  return circles;
}

/// Nodes of a section at its radius 1.
int outside_corners(const Section& section) {
  return static_cast<int>(std::ranges::count(section.radius, 1.0));
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

/// Renumbers so that every node belongs to an element.
void drop_unused_nodes(Mesh& mesh) {
  const std::vector<char> used = used_nodes(mesh);
  std::vector<NodeId> number(used.size(), -1);
  NodeId next = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) continue;
    mesh.nodes.row(next) = mesh.nodes.row(static_cast<Eigen::Index>(i)).eval();
    number[i] = next++;
  }
  mesh.nodes.conservativeResize(next, 3);
  const auto renumber = [&](auto& nodes) {
    for (NodeId& node : nodes) node = number[static_cast<std::size_t>(node)];
  };
  for (auto& element : mesh.tetrahedra) renumber(element);
  for (auto& element : mesh.hexahedra) renumber(element);
  for (auto& [name, nodes] : mesh.node_sets) {
    renumber(nodes);
    std::erase(nodes, -1);
  }
}

/// The grid of a block: node numbers, positions and sets.
class BlockGrid {
 public:
  explicit BlockGrid(const BlockShape& shape) : shape_(shape) {
    for (Eigen::Index a = 0; a < 3; ++a) require_length(shape.size[a], "block", "size");
    require(shape.corner.allFinite(), "block", "the corner is not finite");
    std::int64_t nodes = 1;
    for (const int cells : shape.cells) {
      require_cells(cells, 1, "block", "cells");
      nodes *= cells + 1;
    }
    require(nodes < std::numeric_limits<NodeId>::max(), "block",
            fmt::format("{} nodes are too many", nodes));
  }

  NodeId node(int i, int j, int k) const {
    return (k * (shape_.cells[1] + 1) + j) * (shape_.cells[0] + 1) + i;
  }

  /// Corners of a cell in VTK_HEXAHEDRON order.
  Hexahedron cell(int i, int j, int k) const {
    return {
        node(i, j, k),     node(i + 1, j, k),     node(i + 1, j + 1, k),     node(i, j + 1, k),
        node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)};
  }

  template <typename Visit>
  void for_each_cell(const Visit& visit) const {
    for (int k = 0; k < shape_.cells[2]; ++k) {
      for (int j = 0; j < shape_.cells[1]; ++j) {
        for (int i = 0; i < shape_.cells[0]; ++i) visit(cell(i, j, k));
      }
    }
  }

  Mesh nodes_and_sets() const {
    Mesh mesh;
    mesh.name = "block";
    const auto [nx, ny, nz] = shape_.cells;
    mesh.nodes.resize(node(nx, ny, nz) + 1, 3);
    for (int k = 0; k <= nz; ++k) {
      for (int j = 0; j <= ny; ++j) {
        for (int i = 0; i <= nx; ++i) add_node(mesh, {i, j, k});
      }
    }
    return mesh;
  }

 private:
  void add_node(Mesh& mesh, const std::array<int, 3>& at) const {
    constexpr std::array kNames = {"x", "y", "z"};
    const NodeId number = node(at[0], at[1], at[2]);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      mesh.nodes(number, axis) = shape_.corner[axis] + shape_.size[axis] * at[a] / shape_.cells[a];
      if (at[a] == 0) mesh.node_sets[std::string(kNames[a]) + "_min"].push_back(number);
      if (at[a] == shape_.cells[a]) {
        mesh.node_sets[std::string(kNames[a]) + "_max"].push_back(number);
      }
    }
  }

  BlockShape shape_;
};

}  // namespace

Mesh block(const BlockShape& shape, Cells cells) {
  const BlockGrid grid(shape);
  Mesh mesh = grid.nodes_and_sets();
  // The six monotone paths along edges from corner 0 to corner 6 (Kuhn's triangulation).
  constexpr std::array<std::size_t, 7> kRing = {1, 2, 3, 7, 4, 5, 1};
  grid.for_each_cell([&](const Hexahedron& h) {
    if (cells == Cells::hexahedra) return mesh.hexahedra.push_back(h);
    for (std::size_t k = 0; k < 6; ++k) {
      mesh.tetrahedra.push_back({h[0], h[kRing[k]], h[kRing[k + 1]], h[6]});
    }
  });
  return finished(std::move(mesh), cells, {});
}

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

namespace {

/// The chamber's circle as an O-grid, and rings from it to the outer circle: circles whose centres
/// and radii go evenly from one to the other. Radii in m; ring nodes of the chamber's wall and of
/// the outside are listed.
struct EccentricSection {
  Section section;
  std::vector<NodeId> wall, outside;
  std::size_t core_cells = 0;
  NodeId core_nodes = 0;  // those before the wall's ring
};

EccentricSection eccentric_section(const ChamberedCylinderShape& shape, Cells cells) {
  EccentricSection result;
  Section& section = result.section;
  const Section core = disc_section_of_quadrilaterals(shape.core);
  section.quadrilaterals = core.quadrilaterals;
  result.core_cells = core.quadrilaterals.size();
  const double round = rounding(outside_corners(core), cells);
  const double wall_radius = round * shape.chamber_radius, outer_radius = round * shape.radius;
  const auto add = [&](double x, double y) {
    section.radius.push_back(std::hypot(x, y));
    section.angle.push_back(std::atan2(y, x));
    return static_cast<NodeId>(section.radius.size()) - 1;
  };
  std::vector<double> turn;  // of each node of the wall
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

/// Even layers below, along and above the chamber.
std::vector<double> chamber_heights(const ChamberedCylinderShape& shape) {
  const double size = shape.height / shape.layers;
  std::vector<double> heights{0.0};
  for (const double end : {shape.chamber_bottom, shape.chamber_top, shape.height}) {
    const double begin = heights.back();
    if (end <= begin) continue;
    const int layers = std::max(1, static_cast<int>(std::lround((end - begin) / size)));
    for (int k = 1; k <= layers; ++k) heights.push_back(begin + (end - begin) * k / layers);
  }
  return heights;
}

}  // namespace

Mesh chambered_cylinder(const ChamberedCylinderShape& shape, Cells cells) {
  const std::string name = "chambered cylinder";
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
  EccentricSection plan = eccentric_section(shape, cells);
  const std::vector<double> heights = chamber_heights(shape);
  const auto in_layer = static_cast<NodeId>(plan.section.radius.size());
  if (cells != Cells::hexahedra) {
    for (const auto& [a, b, c, d] : plan.section.quadrilaterals) {
      plan.section.triangles.push_back({a, b, c});
      plan.section.triangles.push_back({a, c, d});
    }
    plan.section.quadrilaterals.clear();
  }
  Mesh mesh = sweep(
      plan.section, heights, [](double s, double) { return s; }, name);
  // The chamber: nodes inside its circle, strictly between its ends, and the elements round them.
  const auto layer_of = [&](NodeId node) { return static_cast<std::size_t>(node / in_layer); };
  const auto inside = [&](const auto& element) {
    double z = 0.0;
    bool core = true;
    for (const NodeId node : element) {
      core = core && node % in_layer < plan.core_nodes + static_cast<NodeId>(plan.wall.size());
      z += heights[layer_of(node)] / static_cast<double>(element.size());
    }
    return core && z > shape.chamber_bottom && z < shape.chamber_top;
  };
  std::erase_if(mesh.tetrahedra, inside);
  std::erase_if(mesh.hexahedra, inside);
  const double tolerance = 1e-9 * shape.height;
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    const double z = heights[layer_of(node)];
    const NodeId at = node % in_layer;
    const bool along = z > shape.chamber_bottom - tolerance && z < shape.chamber_top + tolerance;
    const bool end = (z < shape.chamber_bottom + tolerance && shape.chamber_bottom > 0.0) ||
                     (z > shape.chamber_top - tolerance && shape.chamber_top < shape.height);
    const bool on_wall =
        at >= plan.core_nodes && at < plan.core_nodes + static_cast<NodeId>(plan.wall.size());
    if (along && (on_wall || (end && at < plan.core_nodes))) {
      mesh.node_sets["chamber"].push_back(node);
    }
    if (at >= plan.outside.front()) mesh.node_sets["side"].push_back(node);
  }
  drop_unused_nodes(mesh);
  std::vector<Circle> circles;
  for (int k = 0; k <= shape.through; ++k) {
    const double part = static_cast<double>(k) / shape.through;
    const double radius = std::lerp(shape.chamber_radius, shape.radius, part);
    circles.push_back({(1.0 - part) * shape.chamber_offset, [radius](double) { return radius; }});
  }
  return finished(std::move(mesh), cells, circles);
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
  // Crests at both ends and between bellows; the wave fades towards the axis as s^3, so that the
  // inside stays smooth.
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
