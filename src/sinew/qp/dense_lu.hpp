/// @file
/// LU factorisation with partial pivoting in storage that grows and is kept.
#pragma once

#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::qp {

/// P A = L U of a general matrix (Golub & Van Loan 2013, algorithm 3.4.1, by panels of columns).
class DenseLu {
 public:
  /// @param size unknowns of the systems to come.
  explicit DenseLu(int size) { reserve(size); }
  /// Memory for systems of this size. What matrix() held is lost where it grows.
  void reserve(int size);
  /// (size, size) to be filled before factorise().
  Eigen::Map<MatrixX> matrix(int size) { return {storage_.data(), size, size}; }
  /// @return false where the matrix is singular to working precision.
  bool factorise(int size);
  /// right <- A^-1 right. @param right (size,).
  void solve(Eigen::Ref<VectorX> right) const;

 private:
  bool factor_panel(int first, int width);
  void apply_panel(int first, int width);

  std::vector<double> storage_;
  std::vector<int> pivot_;
  int size_ = 0;
};

}  // namespace sinew::qp
