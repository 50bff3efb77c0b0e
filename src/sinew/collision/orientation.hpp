/// @file
/// Exact orientation predicates, on which every decision about crossing rests.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::collision {

/// Sign (-1, 0, 1) of (b - a) . ((c - a) x (d - a)): positive if d lies on the side to which the
/// normal of the triangle a, b, c points. Exact: a floating-point value decides if its error bound
/// allows, else sums of doubles without rounding (J. R. Shewchuk, Discrete Comput. Geom. 18, 1997,
/// 305). Differences of coordinates must be zero or between 1e-90 and 1e90 in size.
/// @param a,b,c,d (3,) m.
int orientation(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

/// Sign of the component `axis` (0, 1, 2) of (b - a) x (c - a), exact as above.
/// @param a,b,c (3,) m. @param axis the viewing direction.
int orientation_along(int axis, const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace sinew::collision
