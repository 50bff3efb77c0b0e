/// @file
/// Block systems for tests and benchmarks: random graphs of any size, and linear elasticity on
/// structured tetrahedral blocks and tubes of the size of real soft robots.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Dense>

#include "sinew/core/types.hpp"
#include "sinew/linalg/block_pattern.hpp"

namespace sinew::linalg::testing {

/// Matrix A, rows H and right-hand side b in the layouts of the library.
struct BlockSystem {
  BlockPattern pattern;
  BorderPattern border;
  std::vector<double> matrix;
  std::vector<double> rows;
  std::vector<double> right;

  int size() const { return 3 * pattern.nodes; }

  /// Adds a 3x3 block at (i, j) and, by symmetry, its transpose at (j, i); i == j adds once.
  void add(int i, int j, const Matrix3& block) {
    double* to = matrix.data() + kBlockStride * pattern.find(i, j);
    const Matrix3 lower = i >= j ? block : Matrix3(block.transpose());
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) to[4 * c + r] += lower(r, c);
    }
  }

  MatrixX dense_matrix() const {
    MatrixX full = MatrixX::Zero(size(), size());
    for (int j = 0; j < pattern.nodes; ++j) {
      for (int b = pattern.column_start[static_cast<std::size_t>(j)];
           b < pattern.column_start[static_cast<std::size_t>(j) + 1]; ++b) {
        const int i = pattern.row[static_cast<std::size_t>(b)];
        for (int c = 0; c < 3; ++c) {
          for (int r = 0; r < 3; ++r) {
            const double value = matrix[static_cast<std::size_t>(kBlockStride * b + 4 * c + r)];
            full(3 * i + r, 3 * j + c) = value;
            full(3 * j + c, 3 * i + r) = value;
          }
        }
      }
    }
    return full;
  }

  /// Computes A x, block by block.
  VectorX multiply(const VectorX& x) const {
    VectorX y = VectorX::Zero(size());
    for (int j = 0; j < pattern.nodes; ++j) {
      for (int b = pattern.column_start[static_cast<std::size_t>(j)];
           b < pattern.column_start[static_cast<std::size_t>(j) + 1]; ++b) {
        const int i = pattern.row[static_cast<std::size_t>(b)];
        const Eigen::Map<const Eigen::Matrix<double, 4, 3>> padded(matrix.data() +
                                                                   kBlockStride * b);
        const Matrix3 block = padded.topRows<3>();
        y.segment<3>(3 * i) += block * x.segment<3>(3 * j);
        if (i != j) y.segment<3>(3 * j) += block.transpose() * x.segment<3>(3 * i);
      }
    }
    return y;
  }

  MatrixX dense_rows() const {
    MatrixX full = MatrixX::Zero(border.rows(), size());
    for (int k = 0; k < border.rows(); ++k) {
      for (int e = border.row_start[static_cast<std::size_t>(k)];
           e < border.row_start[static_cast<std::size_t>(k) + 1]; ++e) {
        for (int c = 0; c < 3; ++c) {
          full(k, 3 * border.node[static_cast<std::size_t>(e)] + c) =
              rows[static_cast<std::size_t>(3 * e + c)];
        }
      }
    }
    return full;
  }

  VectorX dense_right() const {
    return Eigen::Map<const VectorX>(right.data(), static_cast<Eigen::Index>(right.size()));
  }
};

/// Settings of a random system.
struct RandomSettings {
  int nodes = 10;
  int cliques = 20;
  int clique_size = 4;
  int rows = 0;
  double row_density = 0.2;  ///< probability that a border row touches a node; 1: all
  double negative = 0;       ///< probability that a clique has the opposite sign
  unsigned seed = 1;
};

/// A random system: the sum of C C^T over random cliques, plus a positive diagonal. It is positive
/// definite if no clique is negative. Border rows may be empty.
inline BlockSystem random_system(const RandomSettings& settings) {
  std::mt19937 random(settings.seed);
  std::uniform_int_distribution<int> node(0, settings.nodes - 1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  std::vector<std::int32_t> starts{0};
  std::vector<std::int32_t> members;
  for (int c = 0; c < settings.cliques; ++c) {
    for (int k = 0; k < settings.clique_size; ++k) members.push_back(node(random));
    starts.push_back(static_cast<std::int32_t>(members.size()));
  }
  BlockSystem system;
  system.pattern = BlockPattern::from_cliques(settings.nodes, starts, members);
  system.matrix.assign(static_cast<std::size_t>(kBlockStride * system.pattern.blocks()), 0.0);
  for (int i = 0; i < settings.nodes; ++i) system.add(i, i, Matrix3::Identity());
  for (std::size_t c = 0; c + 1 < starts.size(); ++c) {
    std::vector<std::int32_t> nodes(members.begin() + starts[c], members.begin() + starts[c + 1]);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    const auto size = static_cast<Eigen::Index>(3 * nodes.size());
    const MatrixX factor = MatrixX::NullaryExpr(size, size, [&] { return normal(random); });
    const double sign = unit(random) < settings.negative ? -1.0 : 1.0;
    const MatrixX product = sign * factor * factor.transpose();
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        system.add(nodes[a], nodes[b],
                   product.block<3, 3>(static_cast<Eigen::Index>(3 * a),
                                       static_cast<Eigen::Index>(3 * b)));
      }
    }
  }
  for (int k = 0; k < settings.rows; ++k) {
    for (int i = 0; i < settings.nodes; ++i) {
      if (unit(random) < settings.row_density) system.border.node.push_back(i);
    }
    system.border.row_start.push_back(static_cast<std::int32_t>(system.border.node.size()));
  }
  system.rows.resize(static_cast<std::size_t>(3 * system.border.entries()));
  system.right.resize(static_cast<std::size_t>(3 * settings.nodes));
  for (double& value : system.rows) value = normal(random);
  for (double& value : system.right) value = normal(random);
  return system;
}

/// A tetrahedral mesh with nodes in m.
struct TetrahedralMesh {
  std::vector<Vector3> nodes;
  std::vector<std::array<int, 4>> tets;
};

/// A block of cells with six tetrahedra each (Kuhn); `bent(p)` maps the nodes of the unit-cell
/// grid.
template <typename Bend>
TetrahedralMesh cell_mesh(int nx, int ny, int nz, Bend&& bent) {
  TetrahedralMesh mesh;
  const auto id = [&](int x, int y, int z) { return (z * (ny + 1) + y) * (nx + 1) + x; };
  for (int z = 0; z <= nz; ++z) {
    for (int y = 0; y <= ny; ++y) {
      for (int x = 0; x <= nx; ++x) mesh.nodes.push_back(bent(Vector3(x, y, z)));
    }
  }
  constexpr int kSteps[6][3] = {{1, 2, 4}, {1, 4, 2}, {2, 1, 4}, {2, 4, 1}, {4, 1, 2}, {4, 2, 1}};
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        for (const auto& steps : kSteps) {
          std::array<int, 4> tet{};
          int corner = 0;
          for (int k = 0; k < 4; ++k) {
            tet[static_cast<std::size_t>(k)] =
                id(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2 & 1));
            if (k < 3) corner |= steps[k];
          }
          mesh.tets.push_back(tet);
        }
      }
    }
  }
  return mesh;
}

/// Linear elasticity (Young's modulus 450 kPa, Poisson's ratio 0.45) on a mesh whose first `fixed`
/// nodes are fixed, with `rows` border rows, each along a line of nodes, and a right-hand side.
inline BlockSystem elastic_system(const TetrahedralMesh& mesh, int fixed, int rows) {
  constexpr double kYoung = 450e3;
  constexpr double kPoisson = 0.45;
  constexpr double kLambda = kYoung * kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson));
  constexpr double kMu = kYoung / (2 * (1 + kPoisson));
  const int nodes = static_cast<int>(mesh.nodes.size()) - fixed;
  std::vector<std::int32_t> starts{0};
  std::vector<std::int32_t> members;
  for (const auto& tet : mesh.tets) {
    for (const int node : tet) {
      if (node >= fixed) members.push_back(node - fixed);
    }
    starts.push_back(static_cast<std::int32_t>(members.size()));
  }
  BlockSystem system;
  system.pattern = BlockPattern::from_cliques(nodes, starts, members);
  system.matrix.assign(static_cast<std::size_t>(kBlockStride * system.pattern.blocks()), 0.0);
  for (const auto& tet : mesh.tets) {
    const auto x = [&](std::size_t k) { return mesh.nodes[static_cast<std::size_t>(tet[k])]; };
    Matrix3 edges;
    edges << x(1) - x(0), x(2) - x(0), x(3) - x(0);
    const double volume = std::abs(edges.determinant()) / 6;
    const Matrix3 inverse = edges.inverse();
    Eigen::Matrix<double, 3, 4> gradient;
    gradient.rightCols<3>() = inverse.transpose();
    gradient.col(0) = -gradient.rightCols<3>().rowwise().sum();
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const int i = tet[static_cast<std::size_t>(a)] - fixed;
        const int j = tet[static_cast<std::size_t>(b)] - fixed;
        if (i < 0 || j < 0 || i < j) continue;
        const Vector3 ga = gradient.col(a);
        const Vector3 gb = gradient.col(b);
        system.add(i, j,
                   volume * (kLambda * ga * gb.transpose() + kMu * gb * ga.transpose() +
                             kMu * ga.dot(gb) * Matrix3::Identity()));
      }
    }
  }
  for (int k = 0; k < rows; ++k) {
    const int first = k * 7 % std::max(nodes, 1);
    const int step = std::max(1, nodes / 60);
    for (int i = first; i < nodes && (k % 2 == 0 || i < first + nodes / 3); i += step) {
      system.border.node.push_back(i);
    }
    system.border.row_start.push_back(static_cast<std::int32_t>(system.border.node.size()));
  }
  system.rows.resize(static_cast<std::size_t>(3 * system.border.entries()));
  system.right.resize(static_cast<std::size_t>(3 * nodes));
  for (std::size_t i = 0; i < system.rows.size(); ++i) {
    system.rows[i] = std::sin(1.0 + static_cast<double>(i));
  }
  for (std::size_t i = 0; i < system.right.size(); ++i) {
    system.right[i] = std::cos(2.0 + static_cast<double>(i));
  }
  return system;
}

/// A slender block, clamped at z = 0.
inline BlockSystem elastic_block(int nx, int ny, int nz, int rows) {
  const TetrahedralMesh mesh =
      cell_mesh(nx, ny, nz, [](const Vector3& p) { return Vector3(0.005 * p); });
  return elastic_system(mesh, (nx + 1) * (ny + 1), rows);
}

/// A half tube, clamped at one end, whose wall is `layers` cells thick.
inline BlockSystem elastic_half_tube(int layers, int around, int along, int rows) {
  const TetrahedralMesh mesh = cell_mesh(layers, around, along, [&](const Vector3& p) {
    const double radius = 0.02 + 0.002 * p.x();
    const double angle = std::numbers::pi * p.y() / around;
    return Vector3(radius * std::cos(angle), radius * std::sin(angle), 0.004 * p.z());
  });
  return elastic_system(mesh, (layers + 1) * (around + 1), rows);
}

}  // namespace sinew::linalg::testing
