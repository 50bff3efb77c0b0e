/// @file
/// Nearest points of a vertex and a triangle, and of two edges. Lengths in m.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::collision {

/// The point of an edge nearest to another point.
struct OnEdge {
  double share = 0.0;               ///< in [0, 1], from the edge's first end
  Vector3 point = Vector3::Zero();  ///< (3,) m
};
/// The point of an edge nearest to `point`. @param point (3,) m.
/// @param a,b (3,) m, the ends; they may coincide (share 0).
OnEdge closest_on_edge(const Vector3& point, const Vector3& a, const Vector3& b);

/// The point of a triangle nearest to another point.
struct OnTriangle {
  Vector3 weights = Vector3::Zero();  ///< (3,) of the corners, >= 0, sum 1; 0 off the feature
  Vector3 point = Vector3::Zero();    ///< (3,) m
};
/// The point of a triangle nearest to `point`. Regions as in C. Ericson, "Real-Time Collision
/// Detection", 2005, section 5.1.5: the face if all three weights of the projection are positive,
/// else the nearest of the edges. @param point (3,) m.
/// @param a,b,c (3,) m, the corners; a degenerate triangle is treated as its edges.
OnTriangle closest_on_triangle(const Vector3& point, const Vector3& a, const Vector3& b,
                               const Vector3& c);

/// Nearest points of two edges.
struct OnEdges {
  double first = 0.0, second = 0.0;  ///< in [0, 1], from each edge's first end
  Vector3 first_point = Vector3::Zero(), second_point = Vector3::Zero();  ///< (3,) m
};
/// Nearest points of two edges. |a(s) - b(t)|^2 is a convex quadratic function on the unit square.
/// Its minimum is in the interior, where the gradient is zero, or at an end of one edge. All five
/// candidates are compared by their distance, so that nearly parallel edges lose no digits. For
/// parallel edges, which have many nearest points, the result is at an end.
/// @param a0,a1,b0,b1 (3,) m, the ends; those of an edge may coincide.
OnEdges closest_on_edges(const Vector3& a0, const Vector3& a1, const Vector3& b0,
                         const Vector3& b1);

}  // namespace sinew::collision
