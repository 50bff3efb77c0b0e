/// @file
/// Exact tests whether two triangles, or a segment and a triangle, have a common point.
#pragma once

#include <array>

#include "sinew/core/types.hpp"

namespace sinew::collision {

/// Three corners, (3,) m each.
using Corners = std::array<Vector3, 3>;

/// Whether two closed segments meet. Exact signs (orientation.hpp) decide all cases, including
/// collinear and degenerate segments.
/// @param p,q (3,) m, ends of one. @param a,b (3,) m, ends of the other.
bool segments_meet(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b);

/// Whether a closed segment meets a closed triangle. Exact; touching counts.
/// @param p,q (3,) m, the ends. @param triangle a degenerate one is treated as its edges.
bool segment_meets_triangle(const Vector3& p, const Vector3& q, const Corners& triangle);

/// Whether two closed triangles meet. Exact; touching counts. They meet if an edge of one meets the
/// other. @param first,second may be degenerate.
bool triangles_meet(const Corners& first, const Corners& second);

}  // namespace sinew::collision
