/// @file
/// Shape measures of tetrahedra.
#pragma once

#include <array>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// The corners of a tetrahedron, m.
using Corners = std::array<Vector3, 4>;

/// Positions of the nodes of tetrahedron `element`.
Corners corners_of(const Mesh& mesh, int element);

/// Signed volume (x1-x0) . ((x2-x0) x (x3-x0)) / 6, m^3; positive for VTK's ordering.
double signed_volume(const Corners& corners);

/// Length of the longest edge, m.
double longest_edge(const Corners& corners);

/// 3 r / R, inscribed over circumscribed sphere: 1 for a regular tetrahedron, 0 for a flat one.
/// Source: A. Liu, B. Joe, "Relationship between tetrahedron shape measures", BIT 34, 1994.
double radius_ratio(const Corners& corners);

/// The six angles between faces, rad; 0 and pi for a flat tetrahedron, 70.53 degrees in a regular
/// one.
std::array<double, 6> dihedral_angles(const Corners& corners);

/// Volume of all tetrahedra and hexahedra, m^3.
double volume(const Mesh& mesh);

/// Signed volume of a hexahedron, m^3, split into six tetrahedra round the diagonal 0-6 (exact for
/// plane faces).
double signed_volume(const Mesh& mesh, const Hexahedron& hexahedron);

}  // namespace sinew::mesh
