/// @file
/// How much too stiff linear tetrahedra make a body in bending, estimated from the mesh alone.
///
/// Pure bending by the curvature k in the plane of x, the axis, and y, at a distance y and z from
/// the axis (Timoshenko, Goodier, "Theory of Elasticity", 3rd ed., 1970, section 102):
///   u_x = -k x y,   u_y = k/2 (x^2 + nu (y^2 - z^2)),   u_z = k nu y z,
///   eps_xx = -k y,  eps_yy = eps_zz = nu k y,  no shear,   W = E k^2/2 integral of y^2 dV.
/// Linear tetrahedra that follow it at their nodes have one strain each, which is not this one, and
/// store a larger energy W_h; the part that grows with lambda is locking in volume, the rest that
/// in bending (shear). W_h / W is the factor by which more moment is needed for the same curvature.
/// Free to move, the nodes find a little less, and the tip of a cantilever with n cells of six
/// tetrahedra across its square section has, over beam theory (tests/fem/bending_stiffness_test):
///   n                 1            2            4
///   nu = 0.3     4.5 (5.2)   2.0 (2.0)   1.3 (1.3)      solved (estimated)
///   nu = 0.45    9.0 (10.5)  3.4 (3.5)   1.7 (1.6)
///   nu = 0.49     26 (40)    9.4 (10.8)  3.5 (3.5)
/// A body whose walls bend on their own is stiffened more: the estimate is of the body as a whole.
#pragma once

#include "sinew/mesh/mesh.hpp"

namespace sinew::fem {

/// W_h / W of the file's head, both planes through the longest principal axis together, the weaker
/// counting more: the sum of the two flexibilities over that of the mesh's. 1 or more.
/// @param mesh of linear tetrahedra; hexahedra in it are left out. At least one tetrahedron.
/// @param poisson_ratio nu below 0.5.
double bending_stiffness_ratio(const mesh::Mesh& mesh, double poisson_ratio);

}  // namespace sinew::fem
