/// @file
/// Continuous collision detection: whether, and when, a vertex meets a triangle or an edge an edge,
/// if all points move linearly.
#pragma once

#include <array>
#include <optional>

#include "sinew/core/types.hpp"

namespace sinew::collision {

/// Positions of the four points of a query, (3,) m each.
using FourPoints = std::array<Vector3, 4>;

/// Point i moves linearly from start[i] to end[i] while time runs from 0 to 1. The test is
/// conservative: it returns nothing only if the distance is certainly larger than `separation` over
/// the whole closed interval, whatever the rounding; touching counts. A returned time is a lower
/// bound of the first time at which the distance is at most `separation`. Method:
/// docs/collision.md.
///
/// Coordinates that are not finite count as a meeting at time 0.
/// @param start,end vertex, then the three corners of the triangle.
/// @param separation m, >= 0.
std::optional<double> vertex_face_impact(const FourPoints& start, const FourPoints& end,
                                         double separation = 0.0);

/// As vertex_face_impact(), for two edges.
/// @param start,end both ends of one edge, then both of the other. @param separation m, >= 0.
std::optional<double> edge_edge_impact(const FourPoints& start, const FourPoints& end,
                                       double separation = 0.0);

}  // namespace sinew::collision
