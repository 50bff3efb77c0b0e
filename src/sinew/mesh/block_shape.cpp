// Boxes of cells, whole or with gaps.
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/axis_names.hpp"
#include "sinew/mesh/shape_cells.hpp"
#include "sinew/mesh/shape_checks.hpp"

namespace sinew::mesh {

namespace {

/// Positions of the planes of nodes along an axis, m, ascending.
using Planes = std::vector<double>;

/// A grid of boxes: node numbers, positions and sets.
class BoxGrid {
 public:
  BoxGrid(std::array<Planes, 3> planes, std::string name)
      : planes_(std::move(planes)), name_(std::move(name)) {
    std::int64_t nodes = 1;
    for (const Planes& along : planes_) nodes *= static_cast<std::int64_t>(along.size());
    require(nodes < std::numeric_limits<NodeId>::max(), name_,
            fmt::format("{} nodes are too many", nodes));
  }

  /// Makes the mesh without the cells for which `skip(i, j, k)` is true.
  template <typename Skip>
  Mesh fill(Cells cells, const Skip& skip) const {
    Mesh mesh = nodes_and_sets();
    for (int k = 0; k < cells_along(2); ++k) {
      for (int j = 0; j < cells_along(1); ++j) {
        for (int i = 0; i < cells_along(0); ++i) {
          if (skip(i, j, k)) continue;
          if (cells == Cells::hexahedra) {
            mesh.hexahedra.push_back(cell(i, j, k));
          } else {
            split(mirrored_cell(i, j, k), (i + j + k) % 2 != 0, mesh);
          }
        }
      }
    }
    return mesh;
  }

 private:
  int cells_along(std::size_t axis) const { return static_cast<int>(planes_[axis].size()) - 1; }

  NodeId node(int i, int j, int k) const {
    return (k * (cells_along(1) + 1) + j) * (cells_along(0) + 1) + i;
  }

  /// Corners of a cell in VTK_HEXAHEDRON order.
  Hexahedron cell(int i, int j, int k) const {
    return {
        node(i, j, k),     node(i + 1, j, k),     node(i + 1, j + 1, k),     node(i, j + 1, k),
        node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)};
  }

  /// Corners of the cell after mirroring it along each axis on which its number is odd. Cells that
  /// share a face are mirror images in it, so their tetrahedra fit together; cells at equal
  /// distances from the middle of an axis with an even number of cells are mirror images in it.
  Hexahedron mirrored_cell(int i, int j, int k) const {
    const int x = i % 2, y = j % 2, z = k % 2;
    const auto at = [&](int a, int b, int c) {
      return node(i + (a ^ x), j + (b ^ y), k + (c ^ z));
    };
    return {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0),
            at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)};
  }

  /// The six monotone paths along edges from corner 0 to corner 6 (Kuhn's triangulation).
  /// @param h corners in VTK_HEXAHEDRON order, up to a reflection. @param reflected whether that is
  ///   odd. @param mesh receives six tetrahedra.
  static void split(const Hexahedron& h, bool reflected, Mesh& mesh) {
    constexpr std::array<std::size_t, 7> kRing = {1, 2, 3, 7, 4, 5, 1};
    for (std::size_t q = 0; q < 6; ++q) {
      NodeId first = h[kRing[q]], second = h[kRing[q + 1]];
      if (reflected) std::swap(first, second);
      mesh.tetrahedra.push_back({h[0], first, second, h[6]});
    }
  }

  Mesh nodes_and_sets() const {
    Mesh mesh;
    mesh.name = name_;
    const int nx = cells_along(0), ny = cells_along(1), nz = cells_along(2);
    mesh.nodes.resize(node(nx, ny, nz) + 1, 3);
    for (int k = 0; k <= nz; ++k) {
      for (int j = 0; j <= ny; ++j) {
        for (int i = 0; i <= nx; ++i) add_node(mesh, {i, j, k});
      }
    }
    return mesh;
  }

  void add_node(Mesh& mesh, const std::array<int, 3>& at) const {
    const NodeId number = node(at[0], at[1], at[2]);
    for (std::size_t a = 0; a < 3; ++a) {
      mesh.nodes(number, static_cast<Eigen::Index>(a)) =
          planes_[a][static_cast<std::size_t>(at[a])];
      if (at[a] == 0) mesh.node_sets[std::string(kAxisNames[a]) + "_min"].push_back(number);
      if (at[a] == cells_along(a)) {
        mesh.node_sets[std::string(kAxisNames[a]) + "_max"].push_back(number);
      }
    }
  }

  std::array<Planes, 3> planes_;
  std::string name_;
};

Planes even_planes(double first, double length, int cells) {
  Planes planes;
  for (int k = 0; k <= cells; ++k) planes.push_back(first + length * k / cells);
  return planes;
}

/// Appends planes over a further `length`, in equal cells.
void extend(Planes& planes, double length, int cells) {
  const double first = planes.back();
  for (int k = 1; k <= cells; ++k) planes.push_back(first + length * k / cells);
}

void check(const RibbedFingerShape& shape, const std::string& name) {
  for (Eigen::Index a = 0; a < 3; ++a) require_length(shape.size[a], name, "size");
  require_length(shape.spine, name, "spine");
  require_length(shape.gap, name, "gap");
  require(shape.spine < shape.size.z(), name,
          fmt::format("spine = {} m fills the height of {} m", shape.spine, shape.size.z()));
  require_cells(shape.ribs, 2, name, "ribs");
  require((shape.ribs - 1) * shape.gap < shape.size.x(), name,
          fmt::format("{} gaps of {} m leave no ribs on {} m", shape.ribs - 1, shape.gap,
                      shape.size.x()));
  require_cells(shape.rib_cells, 1, name, "rib_cells");
  require_cells(shape.gap_cells, 1, name, "gap_cells");
  require_cells(shape.width_cells, 1, name, "width_cells");
  require_cells(shape.spine_cells, 1, name, "spine_cells");
  require_cells(shape.rib_rise_cells, 1, name, "rib_rise_cells");
}

}  // namespace

Mesh block(const BlockShape& shape, Cells cells) {
  std::array<Planes, 3> planes;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    require_length(shape.size[axis], "block", "size");
    require(shape.corner.allFinite(), "block", "the corner is not finite");
    require_cells(shape.cells[a], 1, "block", "cells");
    planes[a] = even_planes(shape.corner[axis], shape.size[axis], shape.cells[a]);
  }
  const BoxGrid grid(std::move(planes), "block");
  return finished(grid.fill(cells, [](int, int, int) { return false; }), cells, {});
}

Mesh ribbed_finger(const RibbedFingerShape& shape, Cells cells) {
  const std::string name = "ribbed finger";
  check(shape, name);
  const double rib = (shape.size.x() - (shape.ribs - 1) * shape.gap) / shape.ribs;
  Planes along = {0.0}, up = {0.0};
  for (int k = 0; k < shape.ribs; ++k) {
    if (k > 0) extend(along, shape.gap, shape.gap_cells);
    extend(along, rib, shape.rib_cells);
  }
  extend(up, shape.spine, shape.spine_cells);
  extend(up, shape.size.z() - shape.spine, shape.rib_rise_cells);
  const BoxGrid grid({along, even_planes(0.0, shape.size.y(), shape.width_cells), up}, name);
  const int pitch = shape.rib_cells + shape.gap_cells;
  const auto in_gap = [&](int i, int, int k) {
    return k >= shape.spine_cells && i % pitch >= shape.rib_cells;
  };
  Mesh mesh = grid.fill(cells, in_gap);
  drop_unused_nodes(mesh);
  return finished(std::move(mesh), cells, {});
}

}  // namespace sinew::mesh
