/// @file
/// Solids swept along +z from a triangulated section.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// A plane section: nodes by radius (0 to 1 of the local measure) and angle, and its triangles.
struct Section {
  std::vector<double> radius;  ///< (m,) dimensionless
  std::vector<double> angle;   ///< (m,) rad
  std::vector<Triangle> triangles;
};

/// A disc of radius 1: a centre and rings, ring r with 6 r nodes at radius r / rings. Its triangles
/// are nearly equilateral.
/// @param rings >= 1.
Section disc_section(int rings);

/// A ring of `through` x `around` quadrilaterals, each split in two. Radius 0 is the inside, 1 the
/// outside.
/// @param through cells from the inside to the outside, >= 1.
/// @param around cells round the axis, >= 3.
Section annulus_section(int through, int around);

/// Distance from the axis, m, of a node of section radius `s` at height `z`.
using RadialProfile = std::function<double(double s, double z)>;

/// Stacks the section along z; each prism is split into three tetrahedra by node number, so that
/// neighbours match. Node numbers go layer by layer. Sets: nodes `bottom`, `top`.
/// @param section to sweep.
/// @param heights z of every layer of nodes, ascending, m.
/// @param profile gives the radius.
/// @param name of the mesh.
Mesh sweep(const Section& section, const std::vector<double>& heights, const RadialProfile& profile,
           const std::string& name);

}  // namespace sinew::mesh
