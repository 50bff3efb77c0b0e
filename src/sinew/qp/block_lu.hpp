/// @file
/// LU factorisation of a sparse matrix whose pattern is symmetric and whose values are not.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/block_matrix.hpp"

namespace sinew::qp {

/// The multifrontal method (Duff & Reid, ACM Trans. Math. Software 9, 1983) on the elimination tree
/// of the symmetric pattern, ordered by minimum degree. A front is a dense matrix over the nodes of
/// a supernode and those that they still see; its own rows are eliminated, and what is left is
/// added to the front of its parent. Rows are swapped within a supernode alone, so that no value
/// changes the plan.
class BlockLu {
 public:
  /// Makes the plan, and memory for it, unless the pattern is that of the last call.
  void analyse(const BlockMatrix& pattern);
  /// 9 doubles an entry of the pattern, its blocks as BlockMatrix has them, to be filled before
  /// factorise().
  double* block(int entry) { return &values_[9 * static_cast<std::size_t>(entry)]; }
  /// @return false where a pivot vanishes.
  bool factorise();
  /// right <- A^-1 right. @param right (n,), rows as the pattern's nodes have them.
  void solve(Eigen::Ref<VectorX> right);
  /// Multiplications and additions of one factorisation.
  double flops() const { return flops_; }

 private:
  struct Front {
    int size = 0, own = 0;                       // rows, and those that are eliminated
    std::size_t storage = 0;                     // (size, size) doubles
    std::size_t row = 0;                         // into row_: the unknown that each row is
    std::size_t pivot = 0;                       // into pivot_
    int parent = -1;                             // front that takes the rest
    std::size_t in_parent = 0;                   // into in_parent_: rows of the rest there
    std::size_t block_begin = 0, block_end = 0;  // of scatters_
  };
  struct BlockScatter {
    int entry, row, column;  // of the pattern; in the front
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
  VectorX part_;  // a front's rows of a vector
  double flops_ = 0.0;
  std::vector<int> start_, pattern_row_;  // of the pattern that the plan is for
  std::vector<BlockNode> nodes_;
};

}  // namespace sinew::qp
