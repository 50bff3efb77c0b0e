/// @file
/// Factors of a dense matrix whose leading block is symmetric, in storage that grows and is kept.
#pragma once

#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"

namespace sinew::qp {

/// A = [S C; R D] with S symmetric positive definite. Cholesky's method on S, S = L L^T, carries R
/// and C^T along, and LU factorises what is left of D, its Schur complement D - (R L^-T)(L^-1 C)
/// (Golub & Van Loan 2013, sections 3.2 and 4.2). Where S is most of A, this takes half the
/// operations of LU, and needs no pivots.
class BorderedFactor {
 public:
  /// Shape of the matrix to come, whose entries are then undefined. Allocates only where it has
  /// more rows than all before.
  /// @param leading rows of S. @param rest rows of D.
  void reshape(int leading, int rest);

  using Block = Eigen::Map<MatrixX, 0, Eigen::OuterStride<>>;
  Block leading() { return part(0, leading_); }           ///< S, of which the lower triangle
  Block left() { return part(padded_, rest_); }           ///< R, (rest, leading)
  Block right() { return part(padded_ + rest_, rest_); }  ///< C^T, (rest, leading)
  Eigen::Map<MatrixX> corner() { return {corner_, rest_, rest_}; }  ///< D, (rest, rest)

  /// @return false where S is not positive definite, or a pivot of the rest vanishes. The entries
  /// are lost.
  bool factorise();
  /// right <- A^-1 right. @param right (leading + rest,).
  void solve(Eigen::Ref<VectorX> right);

 private:
  Block part(int row, int rows) {
    return {numbers_.data() + row, rows, leading_, Eigen::OuterStride<>(height_)};
  }
  bool factorise_leading();
  void subtract_product();
  void reserve(int size);

  int leading_ = 0, rest_ = 0;
  int padded_ = 0;  // leading_, filled up with rows of the unit matrix to whole nodes
  int height_ = 0;  // of the panel [S; R; C^T], with numbers behind that the kernels may touch
  linalg::AlignedNumbers numbers_;  // the panel, then D
  double* corner_ = nullptr;
  std::vector<int> pivot_;  // of D
  linalg::AlignedNumbers inverse_, sign_, scratch_, product_, vector_;
};

}  // namespace sinew::qp
