/// @file
/// Whether two triangles, or a segment and a triangle, have a point in common. Exact.
#pragma once

#include <array>

#include "sinew/core/types.hpp"

namespace sinew::collision {

/// Three corners, (3,) m each.
using Corners = std::array<Vector3, 3>;

/// Whether two closed segments meet. All cases, the collinear and those of no length included, are
/// decided by exact signs (orientation.hpp).
/// @param p,q (3,) m, ends of one. @param a,b (3,) m, ends of the other.
bool segments_meet(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b);

/// Whether a closed segment meets a closed triangle; exact, touching counts.
/// @param p,q (3,) m, the ends. @param triangle may be flat: then it is its edges.
bool segment_meets_triangle(const Vector3& p, const Vector3& q, const Corners& triangle);

/// Whether two closed triangles meet; exact, touching counts. They do where an edge of one meets
/// the other one. @param first,second may be flat.
bool triangles_meet(const Corners& first, const Corners& second);

}  // namespace sinew::collision
