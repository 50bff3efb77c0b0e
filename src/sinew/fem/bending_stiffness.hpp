/// @file
/// Estimate of how much linear elements overestimate the bending stiffness of a body, from the mesh
/// alone.
///
/// Pure bending with the curvature k in the plane of the axis x and of y, with y and z measured
/// from the axis (Timoshenko, Goodier, "Theory of Elasticity", 3rd ed., 1970, section 102):
///   u_x = -k x y,   u_y = k/2 (x^2 + nu (y^2 - z^2)),   u_z = k nu y z,
///   eps_xx = -k y,  eps_yy = eps_zz = nu k y,  no shear,   W = E k^2/2 integral of y^2 dV.
/// If the nodes of linear elements follow this field, each tetrahedron has a constant strain, and
/// each hexahedron the strain of its trilinear functions with its mean dilatation. They store a
/// larger energy W_h. The part of the excess that grows with lambda is volumetric
/// locking, the rest is shear locking. W_h / W is the factor on the moment needed for the same
/// curvature. Nodes that are free to move reach a slightly smaller energy. A cantilever with n
/// cells of six tetrahedra across its square section has this stiffness at the tip, relative to
/// beam theory (tests/fem/bending_stiffness_test):
///   n                 1            2            4
///   nu = 0.3     4.5 (5.2)   2.0 (2.0)   1.3 (1.3)      solved (estimated)
///   nu = 0.45    9.0 (10.5)  3.4 (3.5)   1.7 (1.6)
///   nu = 0.49     26 (40)    9.4 (10.8)  3.5 (3.5)
/// A body whose walls bend individually is stiffened more: the estimate treats the body as one
/// beam.
#pragma once

#include "sinew/mesh/mesh.hpp"

namespace sinew::fem {

/// Returns W_h / W as defined at the top of this file, at least 1. It combines bending in the two
/// planes through the longest principal axis: the sum of the two exact flexibilities over the sum
/// of those of the mesh, so that the weaker plane counts more.
/// @param mesh of linear elements, at least one. @param poisson_ratio nu below 0.5.
/// @param patches whether tetrahedra share dilatations in patches (element_patches.hpp). Their
///   dilatation then counts as exact.
double bending_stiffness_ratio(const mesh::Mesh& mesh, double poisson_ratio, bool patches = false);

}  // namespace sinew::fem
