/// @file
/// Coincident points.
#pragma once

#include <utility>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::mesh {

/// For each point, the lowest-numbered earlier point within the tolerance that is not itself
/// merged; itself if there is none.
/// @param points (n, 3); finite.
/// @param considered (n,) or empty for all: points with 0 are not merged.
/// @param relative_tolerance tolerance relative to the diagonal of the bounding box of the
///   considered points.
std::vector<NodeId> weld_map(const Points& points, const std::vector<char>& considered,
                             double relative_tolerance);

/// Pairs (lower, higher) of coincident points, in order of the higher one. Parameters as for
/// weld_map().
std::vector<std::pair<NodeId, NodeId>> find_duplicate_nodes(const Points& points,
                                                            const std::vector<char>& considered,
                                                            double relative_tolerance);

}  // namespace sinew::mesh
