/// @file
/// Factorisation of a dense matrix whose leading block is symmetric. Storage is reused.
#pragma once

#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"

namespace sinew::qp {

/// Factorisation of A = [S C; R D] with S symmetric positive definite. The Cholesky factorisation
/// S = L L^T carries R and C^T along; LU then factorises the Schur complement D - (R L^-T)(L^-1 C)
/// (Golub & Van Loan 2013, sections 3.2 and 4.2). If S is most of A, this takes half the operations
/// of LU and needs no pivoting.
class BorderedFactor {
 public:
  /// Sets the shape of the next matrix, whose entries are then undefined. Allocates only if it has
  /// more rows than any before. @param leading rows of S. @param rest rows of D.
  void reshape(int leading, int rest);

  using Block = Eigen::Map<MatrixX, 0, Eigen::OuterStride<>>;
  Block leading() { return part(0, leading_); }                     ///< S, lower triangle
  Block left() { return part(padded_, rest_); }                     ///< R, (rest, leading)
  Block right() { return part(padded_ + rest_, rest_); }            ///< C^T, (rest, leading)
  Eigen::Map<MatrixX> corner() { return {corner_, rest_, rest_}; }  ///< D, (rest, rest)

  /// Factorises in place; the entries are lost. @return false if S is not positive definite, or if
  /// a pivot of the Schur complement vanishes.
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
  int padded_ = 0;  // leading_, padded with rows of the unit matrix to whole nodes
  int height_ = 0;  // of the panel [S; R; C^T], with the overrun that the kernels may access
  linalg::AlignedNumbers numbers_;  // the panel, then D
  double* corner_ = nullptr;
  std::vector<int> pivot_;  // of D
  linalg::AlignedNumbers inverse_, sign_, scratch_, product_, vector_;
};

}  // namespace sinew::qp
