/// @file
/// Supernodes: consecutive columns of L with the same rows below, stored and computed as one dense
/// panel. Columns with nearly the same pattern are also merged, at the cost of stored zeros.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/linalg/elimination.hpp"

namespace sinew::linalg {

/// Settings for merging columns, and the maximum width of a panel.
struct SupernodeSettings {
  /// A supernode is merged with its parent if that stores at most this many zero 3x3 blocks, ...
  int zero_blocks = 24;
  /// ... or zeros in at most this fraction of the merged panel.
  double zero_fraction = 0.0;
  /// Maximum width of a panel in nodes; wider supernodes are split into equal parts.
  int max_width = 48;
};

/// The columns in their final order, divided into supernodes. Children come before parents.
struct SupernodePartition {
  std::vector<std::int32_t> order;  ///< node eliminated k-th
  std::vector<std::int32_t> start;  ///< supernode s has columns start[s] .. start[s+1]-1
  /// Rows of supernode s below its own columns, ascending, as columns; border nodes are n, n+1, ..
  std::vector<std::vector<std::int32_t>> rows;

  SupernodePartition(const Elimination& elimination, const SupernodeSettings& settings);
  int count() const { return static_cast<int>(start.size()) - 1; }
};

}  // namespace sinew::linalg
