/// @file
/// A sparse symmetric matrix of small dense blocks, one row and column of blocks a node, and the
/// parts into which it falls.
#pragma once

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"

namespace sinew::qp {

/// Rows of a matrix that stand together: a contact's three, or a single one.
struct BlockNode {
  int row = 0;   ///< the first
  int size = 3;  ///< 1 or 3
};

/// Both triangles by columns of blocks, the diagonal included: entry e in start[j] .. start[j+1]-1
/// is the block (row[e], j), a 3x3 matrix with zeros where a node has one row.
class BlockMatrix {
 public:
  /// The blocks of A on the nodes' rows that are not zero; the lower triangle of blocks is read.
  /// Allocates only for more nodes or blocks than ever before.
  /// @param nodes disjoint, in the order that blocks get. @param a (n, n).
  void assign(std::span<const BlockNode> nodes, const Eigen::Ref<const MatrixX>& a);
  /// @param nodes as above. @param a (n, n), compressed.
  void assign(std::span<const BlockNode> nodes, const Eigen::SparseMatrix<double>& a);
  /// The blocks between some nodes of another matrix, with rows 0, 1, .. of its own.
  /// @param whole the other matrix.
  /// @param members ascending; all neighbours of each are among them.
  /// @param number (whole.nodes(),) of each member its place in `members`.
  void assign(const BlockMatrix& whole, std::span<const int> members, std::span<const int> number);

  /// Fills a dense matrix with the blocks between some nodes. @param members,number as above,
  /// of this matrix. @param own (members,) their rows in the dense one. @param a (k, k).
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
  /// y += A(:, columns of node j) by, on rows as the nodes give them. @param j below nodes().
  /// @param by (3,), as many as the node has. @param y (n,).
  void add_column(int j, const Vector3& by, Eigen::Ref<VectorX> y) const;

 private:
  void mirror();

  std::vector<BlockNode> nodes_;
  std::vector<int> start_, row_, diagonal_;
  linalg::AlignedNumbers values_;
  // The lower triangle on its way in, and places in the columns.
  std::vector<int> lower_row_, lower_column_, place_;
  linalg::AlignedNumbers lower_values_;
};

/// The connected parts of a matrix's graph.
class BlockIslands {
 public:
  void find(const BlockMatrix& matrix);
  int count() const { return static_cast<int>(start_.size()) - 1; }
  /// Nodes of a part, ascending.
  std::span<const int> members(int island) const {
    const auto i = static_cast<std::size_t>(island);
    return std::span(order_).subspan(static_cast<std::size_t>(start_[i]),
                                     static_cast<std::size_t>(start_[i + 1] - start_[i]));
  }
  /// Of each node its place among the members of its part.
  std::span<const int> numbers() const { return number_; }

 private:
  std::vector<int> start_{0}, order_, number_;
};

}  // namespace sinew::qp
