/// @file
/// Fill-reducing ordering and elimination tree of the node graph, and the resulting pattern of L.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/linalg/block_pattern.hpp"
#include "sinew/linalg/factorisation.hpp"

namespace sinew::linalg {

/// Adjacency lists of the node graph, without the diagonal.
struct NodeGraph {
  std::vector<std::int32_t> start{0};
  std::vector<std::int32_t> neighbour;

  explicit NodeGraph(const BlockPattern& pattern);
  int nodes() const { return static_cast<int>(start.size()) - 1; }
};

/// Computes a fill-reducing elimination order, where order[k] is the node eliminated k-th:
/// approximate minimum degree (Amestoy, Davis & Duff 2004, ACM TOMS 30, 381) or nested dissection
/// (Karypis & Kumar 1998, SIAM J. Sci. Comput. 20, 359). `which` is amd or metis. Throws
/// Error(internal) if the library fails.
std::vector<std::int32_t> fill_reducing_order(const NodeGraph& graph, Ordering which);

/// The elimination tree (Liu 1990, SIAM J. Matrix Anal. Appl. 11, 134) in postorder, with the block
/// pattern of each column of L. Border nodes n, n+1, .. are below all columns.
struct Elimination {
  std::vector<std::int32_t> order;              ///< node eliminated k-th, in postorder
  std::vector<std::int32_t> parent;             ///< parent of column k; -1 at a root
  std::vector<std::vector<std::int32_t>> rows;  ///< rows of column k below its diagonal, ascending

  /// @param graph,first_order the graph, and the elimination order before postordering.
  /// @param border_of for each node the border nodes that touch it (0-based, ascending).
  Elimination(const NodeGraph& graph, const std::vector<std::int32_t>& first_order,
              const std::vector<std::vector<std::int32_t>>& border_of);
};

/// Postorder of a forest given by parents (-1 at roots): children before parents, subtrees
/// contiguous, children of one parent ascending. result[k] is the old number of the k-th.
std::vector<std::int32_t> postorder(const std::vector<std::int32_t>& parent);

}  // namespace sinew::linalg
