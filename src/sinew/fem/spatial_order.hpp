/// @file
/// An order of nodes in which neighbours in space stand close together, whatever the mesh file's
/// numbering: loops in this order find their data in cache.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::fem {

/// (n,) place of each node along a Z-order curve through the bounding box (Morton, "A computer
/// oriented geodetic data base", IBM, 1966), 2^20 cells an axis; ties keep the file's order.
/// @param nodes (n, 3) m, finite.
std::vector<std::int32_t> spatial_ranks(const Points& nodes);

}  // namespace sinew::fem
