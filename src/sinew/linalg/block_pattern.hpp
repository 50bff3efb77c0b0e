/// @file
/// Fixed patterns of a symmetric matrix of 3x3 blocks, one block per pair of nodes, and of its
/// constraint rows. This file defines their layouts.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace sinew::linalg {

/// Doubles per 3x3 block: three columns padded to four rows, so that a column is one vector load.
/// Entry (r, c) of block b is values[12 b + 4 c + r]; the padding values[12 b + 4 c + 3] is 0.
inline constexpr int kBlockStride = 12;

/// Lower triangle of the block matrix by columns. Column j has the blocks
/// column_start[j] .. column_start[j+1]-1; block b is at (row[b], j), with ascending rows, the
/// diagonal first. Block (i, j), i >= j, is A(3i..3i+2, 3j..3j+2). The upper triangle is omitted.
struct BlockPattern {
  int nodes = 0;
  std::vector<std::int32_t> column_start{0};
  std::vector<std::int32_t> row;

  int blocks() const { return static_cast<int>(row.size()); }
  /// Position of block (i, j) or (j, i); -1 if it is not in the pattern. Binary search.
  int find(int i, int j) const;

  /// Makes the pattern of all diagonal blocks and all pairs (i, j) in a common clique (the nodes of
  /// an element or of a cable segment). Clique c is members[starts[c] .. starts[c+1]-1]. Throws
  /// Error(index-out-of-range).
  static BlockPattern from_cliques(int nodes, std::span<const std::int32_t> starts,
                                   std::span<const std::int32_t> members);

  bool operator==(const BlockPattern&) const = default;
};

/// Pattern of the rows of H: entry e in row_start[k] .. row_start[k+1]-1 is the 3-vector of row k
/// at node[e], with the values border_values[3 e .. 3 e + 2]. The nodes of a row are distinct and
/// ascending.
struct BorderPattern {
  std::vector<std::int32_t> row_start{0};
  std::vector<std::int32_t> node;

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  int entries() const { return static_cast<int>(node.size()); }

  bool operator==(const BorderPattern&) const = default;
};

}  // namespace sinew::linalg
