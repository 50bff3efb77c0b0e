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

/// Signed volume (x1-x0) . ((x2-x0) x (x3-x0)) / 6, m^3; positive for the node order of VTK.
double signed_volume(const Corners& corners);

/// Length of the longest edge, m.
double longest_edge(const Corners& corners);

/// Mean length of the straight edges between the corners of an element, m.
/// @param mesh,element its number: tetrahedra, then hexahedra.
double element_size(const Mesh& mesh, int element);

/// Radius ratio 3 r / R of inscribed and circumscribed sphere: 1 for a regular tetrahedron, 0 for a
/// flat one. Source: A. Liu, B. Joe, "Relationship between tetrahedron shape measures", BIT 34,
/// 1994.
double radius_ratio(const Corners& corners);

/// The six dihedral angles, rad: 0 and pi for a flat tetrahedron, 70.53 degrees for a regular one.
std::array<double, 6> dihedral_angles(const Corners& corners);

/// Edge of a regular tetrahedron, or of a cube, with the mean volume of the elements, m.
/// @param mesh Of elements of one type or of several.
/// @param volume m^3, of all elements.
double mean_edge(const Mesh& mesh, double volume);

/// Total volume of all tetrahedra and hexahedra, m^3.
double volume(const Mesh& mesh);

/// Signed volume of a hexahedron, m^3, as six tetrahedra around the diagonal 0-6; exact for plane
/// faces.
double signed_volume(const Mesh& mesh, const Hexahedron& hexahedron);

}  // namespace sinew::mesh
