/// @file
/// Solids swept along +z from a section of triangles or quadrilaterals.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// A plane section: nodes by radius (0 to 1 of the local measure) and angle, and its cells:
/// triangles become tetrahedra, quadrilaterals hexahedra.
struct Section {
  std::vector<double> radius;  ///< (m,) dimensionless
  std::vector<double> angle;   ///< (m,) rad
  std::vector<Triangle> triangles;
  std::vector<std::array<NodeId, 4>> quadrilaterals;  ///< counter-clockwise
};

/// A disc of radius 1: a centre and rings, ring r with 6 r nodes at radius r / rings. Its triangles
/// are nearly equilateral.
/// @param rings >= 1.
Section disc_section(int rings);

/// A disc of radius 1 of quadrilaterals: a rounded square in the middle, and rings round it whose
/// angles are even (an O-grid).
/// @param rings cells from the axis to the outside, >= 2; half of them, rounded down, in the
/// square.
Section disc_section_of_quadrilaterals(int rings);

/// A ring of `through` x `around` cells. Radius 0 is the inside, 1 the outside.
/// @param through cells from the inside to the outside, >= 1.
/// @param around cells round the axis, >= 3.
/// @param split each into two triangles.
Section annulus_section(int through, int around, bool split);

/// Distance from the axis, m, of a node of section radius `s` at height `z`.
using RadialProfile = std::function<double(double s, double z)>;

/// Stacks the section along z; each prism of a triangle is split into three tetrahedra by node
/// number, so that neighbours match. Node numbers go layer by layer. Sets: nodes `bottom`, `top`.
/// @param section to sweep.
/// @param heights z of every layer of nodes, ascending, m.
/// @param profile gives the radius.
/// @param name of the mesh.
Mesh sweep(const Section& section, const std::vector<double>& heights, const RadialProfile& profile,
           const std::string& name);

}  // namespace sinew::mesh
