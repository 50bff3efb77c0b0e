/// @file
/// Choice of points of a body that determine its pose.
#pragma once

#include <array>
#include <span>

#include "sinew/core/types.hpp"

namespace sinew::mechanics {

/// Three points that are far apart: the farthest from the centre, the farthest from that one, and
/// the farthest from the line through both. @param points (n, 3) m, at least one.
/// @param among their indices; empty: all. @return indices of `points`.
std::array<NodeId, 3> spread_points(const Points& points, std::span<const NodeId> among = {});

/// m, diagonal of the bounding box of points along given axes.
/// @param points (n, 3) m, at least one. @param axes columns.
double box_diagonal(const Points& points, const Matrix3& axes);

}  // namespace sinew::mechanics
