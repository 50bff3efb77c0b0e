/// @file
/// Thin layers on faces of volume elements, such as paper, fabric or a film. They resist in-plane
/// stretch but not bending, and have no mass.
///
/// The law is Saint Venant-Kirchhoff in plane stress, on constant-strain triangles. With the
/// gradients g_a (2-vectors in the plane of the triangle at rest) and V = area times thickness,
///   F = sum of x_a g_a^T (3 x 2),   E = (F^T F - I)/2,
///   U = V/2 S : E,   S = lambda tr(E) I + 2 mu E,
///   lambda = E_y nu/(1 - nu^2),   2 mu = E_y/(1 + nu),   f_a = V F S g_a,
///   K_ab = V [(g_a . S g_b) I + lambda (F g_a)(F g_b)^T
///             + mu ((g_a . g_b) F F^T + (F g_b)(F g_a)^T)]
/// (Bonet, Wood, "Nonlinear Continuum Mechanics for Finite Element Analysis", 2nd ed., 2008,
/// sections 9.3 and 9.4, in two material dimensions). The last two terms are B^T D B, which is
/// positive semidefinite and does not resist spins. The first is the geometric stiffness; positive
/// semidefinite tangents use its positive part. The law is meant for layers that stretch by a few
/// per cent, such as a stiff layer on a soft body that bends.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/block_pattern.hpp"
#include "sinew/material/elastic_constants.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {
struct Mesh;
}

namespace sinew::fem {

enum class Tangent;

/// Settings of a membrane. Its faces are faces of volume elements. A quadrilateral is split along
/// both diagonals, into two pairs of triangles of half the thickness; a quadratic triangle into
/// four triangles.
struct MembraneLayer {
  std::string name;
  std::vector<mesh::Face> faces;
  double thickness = 0.0;  ///< m, > 0
  material::ElasticConstants constants;
};

/// The membranes of a body. Immutable.
class Membranes {
 public:
  Membranes() = default;
  /// @param mesh at rest. @param layers with faces of its elements.
  /// @param free_index mesh node -> free or -1. @param pattern contains every pair of nodes of a
  ///   volume element. Throws Error: out-of-range (thickness), invalid-material.
  Membranes(const mesh::Mesh& mesh, std::span<const MembraneLayer> layers,
            std::span<const NodeId> free_index, const linalg::BlockPattern& pattern);

  bool empty() const { return triangles_.empty(); }
  double area(std::size_t layer) const { return areas_[layer]; }  ///< m^2, at rest
  /// Adds the membrane forces and, unless the tangent is none, stiffness times K to the matrix.
  /// @param positions (n, 3) m. @param tangent kind of K. @param stiffness factor of K.
  /// @param forces (3 free,) N. @param matrix layout of linalg::BlockPattern. @return U, J.
  double add(const Points& positions, Tangent tangent, double stiffness, std::span<double> forces,
             std::span<double> matrix) const;

 private:
  struct Block {
    std::int32_t position = -1;  // -1: a node of the pair is fixed
    std::uint8_t a = 0, b = 0;   // local nodes of row and column
  };
  struct Triangle {
    std::array<NodeId, 3> node;
    std::array<std::int32_t, 3> free;
    std::array<Block, 6> blocks;
    std::array<Eigen::Vector2d, 3> gradient;  // 1/m
    double volume = 0.0;                      // m^3
    double lambda = 0.0, mu = 0.0;            // Pa
  };
  struct Strained;
  static Triangle at_rest(const Points& nodes, const std::array<NodeId, 3>& node);
  static void find_blocks(std::span<const NodeId> free_index, const linalg::BlockPattern& pattern,
                          Triangle& triangle);
  static void add_stiffness(const Triangle& triangle, const Strained& now, Tangent tangent,
                            double stiffness, std::span<double> matrix);

  std::vector<Triangle> triangles_;
  std::vector<double> areas_;  // m^2
};

}  // namespace sinew::fem
