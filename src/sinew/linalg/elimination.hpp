/// @file
/// Ordering and elimination tree of the node graph: which node is eliminated when, and which blocks
/// of L that fills.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/linalg/block_pattern.hpp"
#include "sinew/linalg/factorisation.hpp"

namespace sinew::linalg {

/// Symmetric adjacency of the node graph without the diagonal, both triangles, by nodes.
struct NodeGraph {
  std::vector<std::int32_t> start{0};
  std::vector<std::int32_t> neighbour;

  explicit NodeGraph(const BlockPattern& pattern);
  int nodes() const { return static_cast<int>(start.size()) - 1; }
};

/// A fill-reducing elimination order, `order[k]` = the node eliminated k-th: approximate minimum
/// degree (Amestoy, Davis & Duff 2004, ACM TOMS 30, 381) or nested dissection (Karypis & Kumar
/// 1998, SIAM J. Sci. Comput. 20, 359). `which` is amd or metis. Throws Error(internal) if the
/// library fails.
std::vector<std::int32_t> fill_reducing_order(const NodeGraph& graph, Ordering which);

/// The elimination tree (Liu 1990, SIAM J. Matrix Anal. Appl. 11, 134) in postorder, with the
/// blocks that each column of L holds. Border nodes n, n+1, .. stand below all columns.
struct Elimination {
  std::vector<std::int32_t> order;              ///< node eliminated k-th, postordered
  std::vector<std::int32_t> parent;             ///< of column k in the tree; -1 at a root
  std::vector<std::vector<std::int32_t>> rows;  ///< of column k below its diagonal, ascending

  /// @param graph,first_order what is eliminated, and the order before it is made a postorder.
  /// @param border_of for each node the border nodes that touch it (0-based, ascending).
  Elimination(const NodeGraph& graph, const std::vector<std::int32_t>& first_order,
              const std::vector<std::vector<std::int32_t>>& border_of);
};

/// Postorder of a forest given by parents (-1 at roots): children before parents, subtrees
/// contiguous, children of one parent in ascending order. `result[k]` = old number of the k-th.
std::vector<std::int32_t> postorder(const std::vector<std::int32_t>& parent);

}  // namespace sinew::linalg
