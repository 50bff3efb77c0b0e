/// @file
/// Solids swept along +z, from a section of triangles or quadrilaterals.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// A plane section: nodes by radius (0 to 1, see RadialProfile) and angle, and cells. Triangles
/// become tetrahedra, quadrilaterals hexahedra.
struct Section {
  std::vector<double> radius;  ///< (m,) dimensionless
  std::vector<double> angle;   ///< (m,) rad
  std::vector<Triangle> triangles;
  std::vector<std::array<NodeId, 4>> quadrilaterals;  ///< counter-clockwise
};

/// A disc of radius 1 of nearly equilateral triangles: a centre, and rings of 6 r nodes at radius r
/// / rings.
/// @param rings >= 1.
Section disc_section(int rings);

/// A disc of radius 1 of quadrilaterals: a rounded square in the middle, with rings of equal angles
/// around it (an O-grid).
/// @param rings cells from the axis to the outside, >= 2; half of them, rounded up, are in the
///   square.
Section disc_section_of_quadrilaterals(int rings);

/// An annulus of `through` x `around` cells. Radius 0 is the inside, 1 the outside.
/// @param through cells from the inside to the outside, >= 1.
/// @param around cells around the axis, >= 3.
/// @param split whether to split each cell into two triangles.
Section annulus_section(int through, int around, bool split);

/// Distance from the axis, m, of a node with section radius `s` at height `z`, m.
using RadialProfile = std::function<double(double s, double z)>;

/// Sweeps a section along z. Each prism over a triangle is split into three tetrahedra by node
/// number, so that neighbours conform. Nodes are numbered layer by layer. Node sets: `bottom`,
/// `top`.
/// @param section to sweep.
/// @param heights z of every layer of nodes, ascending, m.
/// @param profile radius of each node.
/// @param name of the mesh.
Mesh sweep(const Section& section, const std::vector<double>& heights, const RadialProfile& profile,
           const std::string& name);

}  // namespace sinew::mesh
