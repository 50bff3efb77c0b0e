/// @file
/// Lengths of actuators that run along a spatial segment, and the bend that they tell.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::pcc {

/// A segment's bend towards x and y of its section (rad), and its length (m).
struct Bent {
  double u = 0.0, v = 0.0;
  double length = 0.0;
};

/// (n,) m: l_i = L - r (u cos beta_i + v sin beta_i), the arcs at radius r about the axis (Webster
/// & Jones 2010, sec. 4, in coordinates without a singularity).
/// @param bent of the segment. @param radius r, m. @param angles (n,) beta, rad.
VectorX actuator_lengths(const Bent& bent, double radius, const VectorX& angles);

/// The bend and length whose actuators have lengths nearest to these, by least squares: exact for
/// three, and for more where they agree.
/// @param lengths (n,) m, n >= 3. @param radius r, m, > 0. @param angles (n,) rad.
/// Throws Error(wrong-length | out-of-range | singular-matrix): fewer than three, a radius of zero,
/// angles that leave the bend open.
Bent bend_of_lengths(const VectorX& lengths, double radius, const VectorX& angles);

}  // namespace sinew::pcc
