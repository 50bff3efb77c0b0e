/// @file
/// Nearest points of two convex solids.
#pragma once

#include "sinew/collision/symmetric_solid.hpp"

namespace sinew::collision {

/// Nearest points of two cores: solids without their balls.
struct NearestCores {
  Vector3 on_first = Vector3::Zero(), on_second = Vector3::Zero();  ///< (3,) m
  bool apart = false;  ///< else they overlap, and the points mean nothing
};
/// E. G. Gilbert, D. W. Johnson & S. S. Keerthi, IEEE Journal of Robotics and Automation 4, 1988,
/// 193. The support function bounds the distance from below: iterations end once it is within 1e-14
/// of itself, or rounding stops its fall. Polytopes end in finitely many steps.
/// @param first,second the two solids; their balls do not count.
/// @param shift (3,) m, by which the first is moved.
NearestCores nearest_cores(const SymmetricSolid& first, const SymmetricSolid& second,
                           const Vector3& shift = Vector3::Zero());

}  // namespace sinew::collision
