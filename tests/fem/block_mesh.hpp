/// @file
/// Blocks of tetrahedra for tests and benchmarks.
#pragma once

#include <array>
#include <memory>
#include <random>

#include "sinew/mesh/mesh.hpp"

namespace sinew::fem {

inline constexpr double kEdge = 0.01;  ///< m, edge of a cell in most tests

/// A box of nx x ny x nz cells with edges of `size` (m) and six tetrahedra each (Kuhn's
/// subdivision). All nodes are moved at random by up to `jitter` edges in each direction.
inline std::shared_ptr<mesh::Mesh> block_mesh(int nx, int ny, int nz, double size,
                                              double jitter = 0.0) {
  auto result = std::make_shared<mesh::Mesh>();
  result->name = "block";
  result->nodes.resize((nx + 1) * (ny + 1) * (nz + 1), 3);
  const auto number = [=](int x, int y, int z) { return (z * (ny + 1) + y) * (nx + 1) + x; };
  std::mt19937 random(7);
  std::uniform_real_distribution<double> move(-jitter, jitter);
  for (int z = 0; z <= nz; ++z) {
    for (int y = 0; y <= ny; ++y) {
      for (int x = 0; x <= nx; ++x) {
        const Vector3 offset(move(random), move(random), move(random));
        result->nodes.row(number(x, y, z)) = size * (Vector3(x, y, z) + offset).transpose();
      }
    }
  }
  constexpr std::array<std::array<int, 3>, 6> kAxes{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}}};
  for (int cell = 0; cell < nx * ny * nz; ++cell) {
    for (std::size_t k = 0; k < kAxes.size(); ++k) {
      std::array<int, 3> at{cell % nx, cell / nx % ny, cell / (nx * ny)};
      mesh::Tetrahedron tetrahedron{number(at[0], at[1], at[2])};
      for (std::size_t a = 0; a < 3; ++a) {
        ++at[static_cast<std::size_t>(kAxes[k][a])];
        tetrahedron[a + 1] = number(at[0], at[1], at[2]);
      }
      if (k >= 3) std::swap(tetrahedron[2], tetrahedron[3]);  // odd permutations are mirrored
      result->tetrahedra.push_back(tetrahedron);
    }
  }
  return result;
}

/// The nodes with z < size / 2 in mesh coordinates.
inline std::vector<NodeId> bottom_nodes(const mesh::Mesh& mesh, double size) {
  std::vector<NodeId> result;
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    if (mesh.nodes(node, 2) < 0.5 * size) result.push_back(node);
  }
  return result;
}

/// Moves every node at random by up to `size` edges in each direction.
inline Points moved(const mesh::Mesh& mesh, double edge, double size, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  Points result = mesh.nodes;
  for (double& x : result.reshaped()) x += edge * uniform(random);
  return result;
}

}  // namespace sinew::fem
