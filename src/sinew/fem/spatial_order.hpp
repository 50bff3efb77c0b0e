/// @file
/// An order of nodes in which neighbours in space are close, whatever the numbering of the mesh
/// file. Loops in this order find their data in cache.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::fem {

/// (n,) rank of each node along a Z-order curve through the bounding box (Morton, "A computer
/// oriented geodetic data base", IBM, 1966), with 2^20 cells per axis; ties keep the order of the
/// file.
/// @param nodes (n, 3) m, finite.
std::vector<std::int32_t> spatial_ranks(const Points& nodes);

}  // namespace sinew::fem
