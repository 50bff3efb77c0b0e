/// @file
/// Nearest points of two convex solids.
#pragma once

#include "sinew/collision/symmetric_solid.hpp"

namespace sinew::collision {

/// Nearest points of the cores of two solids, which are the solids without their balls.
struct NearestCores {
  Vector3 on_first = Vector3::Zero(), on_second = Vector3::Zero();  ///< (3,) m
  bool apart = false;  ///< false: they overlap, and the points are meaningless
};
/// Finds them by the method of E. G. Gilbert, D. W. Johnson & S. S. Keerthi, IEEE Journal of
/// Robotics and Automation 4, 1988, 193. The support function gives a lower bound of the distance.
/// Iterations end when the bound is within a relative 1e-14, or when rounding stops the decrease.
/// For polytopes they are finitely many.
/// @param first,second the two solids, whose balls are ignored.
/// @param shift (3,) m, displacement of the first.
NearestCores nearest_cores(const SymmetricSolid& first, const SymmetricSolid& second,
                           const Vector3& shift = Vector3::Zero());

}  // namespace sinew::collision
