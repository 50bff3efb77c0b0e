// A box of cubes.
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/mesh/shape_cells.hpp"
#include "sinew/mesh/shape_checks.hpp"

namespace sinew::mesh {

namespace {

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

}  // namespace sinew::mesh
