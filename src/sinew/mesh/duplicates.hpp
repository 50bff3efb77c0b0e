/// @file
/// Points at the same place.
#pragma once

#include <utility>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::mesh {

/// For each point the lowest-numbered point within the tolerance; itself when there is none. Points
/// are looked at in order, so that chains of near points join the first of them that is near.
/// @param points (n, 3); finite.
/// @param considered (n,) or empty for all: points with 0 stay alone.
/// @param relative_tolerance times the diagonal of the bounding box of the points considered.
std::vector<NodeId> weld_map(const Points& points, const std::vector<char>& considered,
                             double relative_tolerance);

/// Pairs (lower, higher) of points at the same place, in order of the higher one. Parameters as for
/// weld_map().
std::vector<std::pair<NodeId, NodeId>> find_duplicate_nodes(const Points& points,
                                                            const std::vector<char>& considered,
                                                            double relative_tolerance);

}  // namespace sinew::mesh
