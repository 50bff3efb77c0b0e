/// @file
/// A sparse symmetric matrix of small dense blocks, with one block row and column per node, and the
/// connected components of its graph.
#pragma once

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"

namespace sinew::qp {

/// Consecutive rows of a matrix that form a node: the three of a contact, or a single one.
struct BlockNode {
  int row = 0;   ///< first row
  int size = 3;  ///< 1 or 3
};

/// Block-sparse matrix: both triangles, by block columns, with the diagonal. Entry e in start[j] ..
/// start[j+1]-1 is the block (row[e], j), a 3x3 matrix padded with zeros where a node has one row.
class BlockMatrix {
 public:
  /// Copies the nonzero blocks of A on the rows of the nodes. Reads the lower triangle of blocks.
  /// Allocates only if there are more nodes or blocks than ever before.
  /// @param nodes disjoint, in the order of the blocks. @param a (n, n).
  void assign(std::span<const BlockNode> nodes, const Eigen::Ref<const MatrixX>& a);
  /// @param nodes as above. @param a (n, n), compressed.
  void assign(std::span<const BlockNode> nodes, const Eigen::SparseMatrix<double>& a);
  /// Copies the blocks between some nodes of another matrix. Rows are numbered 0, 1, ...
  /// @param whole the other matrix.
  /// @param members ascending; all neighbours of each member are members.
  /// @param number (whole.nodes(),) the index of each member in `members`.
  void assign(const BlockMatrix& whole, std::span<const int> members, std::span<const int> number);

  /// Fills a dense matrix with the blocks between some nodes of this matrix.
  /// @param members,number as above. @param own (members,) their rows in the dense matrix.
  /// @param a (k, k).
  void gather(std::span<const int> members, std::span<const int> number,
              std::span<const BlockNode> own, Eigen::Map<MatrixX> a) const;

  int nodes() const { return static_cast<int>(nodes_.size()); }
  int blocks() const { return static_cast<int>(row_.size()); }
  const BlockNode& node(int i) const { return nodes_[static_cast<std::size_t>(i)]; }
  std::span<const BlockNode> all_nodes() const { return nodes_; }
  std::span<const int> starts() const { return start_; }
  std::span<const int> rows() const { return row_; }
  Eigen::Map<const Matrix3> block(int entry) const {
    return Eigen::Map<const Matrix3>(&values_[9 * static_cast<std::size_t>(entry)]);
  }
  Eigen::Map<const Matrix3> diagonal(int j) const {
    return block(diagonal_[static_cast<std::size_t>(j)]);
  }
  bool all_finite() const;
  /// y += A(:, columns of node j) by, in the row numbering of the nodes. @param j below nodes().
  /// @param by (3,); a node with one row uses the first entry only. @param y (n,).
  void add_column(int j, const Vector3& by, Eigen::Ref<VectorX> y) const;

 private:
  void mirror();

  std::vector<BlockNode> nodes_;
  std::vector<int> start_, row_, diagonal_;
  linalg::AlignedNumbers values_;
  // The lower triangle during assign(), and positions in the columns.
  std::vector<int> lower_row_, lower_column_, place_;
  linalg::AlignedNumbers lower_values_;
};

/// Connected components of the graph of a matrix.
class BlockIslands {
 public:
  void find(const BlockMatrix& matrix);
  int count() const { return static_cast<int>(start_.size()) - 1; }
  /// Nodes of a component, ascending.
  std::span<const int> members(int island) const {
    const auto i = static_cast<std::size_t>(island);
    return std::span(order_).subspan(static_cast<std::size_t>(start_[i]),
                                     static_cast<std::size_t>(start_[i + 1] - start_[i]));
  }
  /// Index of each node among the members of its component.
  std::span<const int> numbers() const { return number_; }

 private:
  std::vector<int> start_{0}, order_, number_;
};

}  // namespace sinew::qp
