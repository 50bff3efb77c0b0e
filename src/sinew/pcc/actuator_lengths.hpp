/// @file
/// Lengths of actuators that run along a spatial segment, and the bend computed from them.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::pcc {

/// Shape of a segment: bend towards x and y of its section (rad), and length (m).
struct Bent {
  double u = 0.0, v = 0.0;
  double length = 0.0;
};

/// Lengths (n,) m of actuators at radius r about the axis, l_i = L - r (u cos beta_i + v sin
/// beta_i) (Webster & Jones 2010, sec. 4, in coordinates without a singularity).
/// @param bent shape of the segment. @param radius r, m. @param angles (n,) beta, rad.
VectorX actuator_lengths(const Bent& bent, double radius, const VectorX& angles);

/// Fits bend and length to actuator lengths by least squares. The fit is exact for three actuators,
/// and for more if their lengths are consistent.
/// @param lengths (n,) m, n >= 3. @param radius r, m, > 0. @param angles (n,) rad.
/// Throws Error: wrong-length (fewer than three), out-of-range (the radius), singular-matrix
/// (angles that do not determine the bend).
Bent bend_of_lengths(const VectorX& lengths, double radius, const VectorX& angles);

}  // namespace sinew::pcc
