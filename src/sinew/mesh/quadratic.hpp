/// @file
/// The quadratic tetrahedron: shape functions, and conversion of linear meshes.
#pragma once

#include <array>
#include <optional>

#include "sinew/core/types.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// The two corners of each edge, in the order of the middle nodes 4 to 9.
inline constexpr std::array<std::array<std::size_t, 2>, 6> kEdges = {
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// Shape functions N_a at barycentric coordinates L: L (2 L - 1) at corners, 4 L_i L_j at middle
/// nodes
/// (Zienkiewicz, Taylor, Zhu, "The Finite Element Method", 6th ed., 2005, volume 1, section 4.10).
std::array<double, 10> quadratic_shapes(const std::array<double, 4>& barycentric);
/// Derivatives dN_a/d(L_1, L_2, L_3), (10, 3).
Eigen::Matrix<double, 10, 3> quadratic_gradients(const std::array<double, 4>& barycentric);
/// Four quadrature points of equal weight, exact for polynomials of degree 2 (Keast, CMAME 55,
/// 1986).
const std::array<std::array<double, 4>, 4>& quadratic_points();
/// Integral of N_a N_b over an element with straight edges, divided by its volume.
const Eigen::Matrix<double, 10, 10>& quadratic_products();

/// Barycentric coordinates of a point in a curved element, by Newton's method from those in its
/// corner tetrahedron; all in [0, 1] if the point is inside. None if it does not converge (a point
/// far outside of a distorted element).
/// @param point (3,) m. @param nodes (10, 3) m.
std::optional<std::array<double, 4>> quadratic_coordinates(
    const Vector3& point, const Eigen::Matrix<double, 10, 3>& nodes);

/// The middle node between two corners; -1 if they are not two corners of the element.
NodeId middle_node(const QuadraticTetrahedron& element, NodeId first, NodeId second);

/// Adds middle nodes on all edges of the tetrahedra, numbered after the existing nodes. A middle
/// node joins the sets that contain both ends of its edge. Triangles are unchanged.
/// @param mesh of tetrahedra; returned as it is if they are quadratic. Throws
///   Error(unsupported-element) for hexahedra.
Mesh with_middle_nodes(const Mesh& mesh);

}  // namespace sinew::mesh
