/// @file
/// The fixed pattern of a symmetric matrix of 3x3 blocks, one block a pair of nodes, and the
/// pattern of constraint rows upon it. Layouts are drawn here once.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace sinew::linalg {

/// Doubles stored per 3x3 block: three columns padded to four rows, so that a column is one vector
/// load. Entry (r, c) of block b is values[12 b + 4 c + r]; values[12 b + 4 c + 3] is padding and
/// 0.
inline constexpr int kBlockStride = 12;

/// Lower triangle of the node graph by columns: block b in column_start[j] .. column_start[j+1]-1
/// stands at (row[b], j), rows ascending, the diagonal first. The block (i, j), i > j, holds
/// A(3i..3i+2, 3j..3j+2); the upper triangle is its transpose and is not stored.
struct BlockPattern {
  int nodes = 0;
  std::vector<std::int32_t> column_start{0};
  std::vector<std::int32_t> row;

  int blocks() const { return static_cast<int>(row.size()); }
  /// Position of block (i, j) (any order); -1 if it is not in the pattern. Binary search.
  int find(int i, int j) const;

  /// The pattern with all diagonal blocks and every pair (i, j) that stands together in a clique
  /// (an element's nodes, a cable segment's nodes). Cliques are rows of `members` split at
  /// `starts`.
  static BlockPattern from_cliques(int nodes, std::span<const std::int32_t> starts,
                                   std::span<const std::int32_t> members);

  bool operator==(const BlockPattern&) const = default;
};

/// Rows of H with fixed patterns: entry e in row_start[k] .. row_start[k+1]-1 is row k's 3-vector
/// at node[e]; its values are border_values[3 e .. 3 e + 2]. Nodes within a row are distinct,
/// ascending.
struct BorderPattern {
  std::vector<std::int32_t> row_start{0};
  std::vector<std::int32_t> node;

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  int entries() const { return static_cast<int>(node.size()); }

  bool operator==(const BorderPattern&) const = default;
};

}  // namespace sinew::linalg
