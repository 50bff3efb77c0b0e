/// @file
/// LU factorisation of a sparse matrix with a symmetric pattern and unsymmetric values.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/block_matrix.hpp"

namespace sinew::qp {

/// Multifrontal LU factorisation of a block-sparse matrix. It follows the elimination tree of the
/// symmetric pattern, ordered by minimum degree (Duff & Reid, ACM Trans. Math. Software 9, 1983). A
/// front is a dense matrix over the nodes of a supernode and those that are still coupled to them.
/// The rows of the supernode are eliminated in the front, and the Schur complement is added to the
/// front of its parent. Rows are exchanged within a supernode only, so the symbolic factorisation
/// does not depend on the values.
class BlockLu {
 public:
  /// Symbolic factorisation and allocation; does nothing if the pattern is that of the last call.
  void analyse(const BlockMatrix& pattern);
  /// Values of one block of the pattern: 9 doubles, laid out as in BlockMatrix, to be filled before
  /// factorise().
  double* block(int entry) { return &values_[9 * static_cast<std::size_t>(entry)]; }
  /// Numeric factorisation. @return false if a pivot vanishes.
  bool factorise();
  /// right <- A^-1 right. @param right (n,), in the row numbering of the pattern's nodes.
  void solve(Eigen::Ref<VectorX> right);
  /// Multiplications and additions of one factorisation.
  double flops() const { return flops_; }

 private:
  struct Front {
    int size = 0, own = 0;      // number of rows, and of those that are eliminated
    std::size_t storage = 0;    // (size, size) doubles
    std::size_t row = 0;        // into row_: the unknown of each row
    std::size_t pivot = 0;      // into pivot_
    int parent = -1;            // front to which the Schur complement is added
    std::size_t in_parent = 0;  // into in_parent_: rows of the remainder in the parent
    std::size_t block_begin = 0, block_end = 0;  // of scatters_
  };
  struct BlockScatter {
    int entry, row, column;  // entry of the pattern; row and column in the front
    int rows, columns;
  };

  bool planned_for(const BlockMatrix& pattern) const;
  void make_fronts(const BlockMatrix& pattern);
  void place_blocks(const BlockMatrix& pattern, std::span<const int> position,
                    std::span<const int> front_of);
  void find_parents(std::span<const int> front_of_row);
  void assemble(const Front& front);
  Eigen::Map<MatrixX> matrix(const Front& front) {
    return {&storage_[front.storage], front.size, front.size};
  }

  std::vector<Front> fronts_;  // children before parents
  std::vector<int> children_begin_, children_;
  std::vector<int> row_, in_parent_, pivot_;
  std::vector<BlockScatter> scatters_;
  linalg::AlignedNumbers storage_, values_;
  VectorX part_;  // the rows of a vector in one front
  double flops_ = 0.0;
  std::vector<int> start_, pattern_row_;  // of the analysed pattern
  std::vector<BlockNode> nodes_;
};

}  // namespace sinew::qp
