/// @file
/// LU factorisation with partial pivoting. Storage is reused.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::qp {

/// Eliminates the first `pivot.size()` rows and columns of a square matrix in place: P A = L U
/// there (Golub & Van Loan 2013, algorithm 3.4.1), and in the rest A_22 - L_21 U_12. Pivots are
/// chosen among the rows that are eliminated. Works by groups of columns from left to right:
/// finished groups update a new group by matrix products, and panels update each other within it.
/// The order of all operations depends on n and k alone. @param a (n, n). @param pivot (k,) out:
/// the row that row i was swapped with. @return false if a pivot vanishes.
bool eliminate(const Eigen::Map<MatrixX>& a, std::span<int> pivot);

/// right <- A^-1 right, with the factors of a whole matrix.
/// @param lu (n, n) factors and @param pivot (n,) row exchanges, both from eliminate().
/// @param right (n,).
void substitute(const Eigen::Ref<const MatrixX>& lu, std::span<const int> pivot,
                Eigen::Ref<VectorX> right);

/// LU factors of a whole matrix.
class DenseLu {
 public:
  /// @param size number of unknowns to allocate for.
  explicit DenseLu(int size) { reserve(size); }
  /// Allocates for systems of this size. The contents of matrix() are lost if it grows.
  void reserve(int size);
  /// The matrix, (size, size), to be filled before factorise().
  Eigen::Map<MatrixX> matrix(int size) { return {storage_.data(), size, size}; }
  /// Factorises the matrix in place. @return false if it is singular to working precision.
  bool factorise(int size);
  /// right <- A^-1 right. @param right (size,).
  void solve(Eigen::Ref<VectorX> right) const;

 private:
  std::vector<double> storage_;
  std::vector<int> pivot_;
  int size_ = 0;
};

}  // namespace sinew::qp
