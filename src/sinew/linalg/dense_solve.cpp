// Linear systems and least squares of dense.hpp.
#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "sinew/linalg/dense.hpp"
#include "sinew/linalg/dense_factor.hpp"

namespace sinew::linalg {

LeastSquares least_squares(const MatrixX& a, const MatrixX& b) {
  const Eigen::ColPivHouseholderQR<MatrixX> decomposed(a);
  return {decomposed.solve(b), decomposed.rank()};
}

MatrixX upper_factor(const MatrixX& a) {
  const Eigen::HouseholderQR<MatrixX> decomposed(a);
  return decomposed.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>();
}

MatrixX pseudo_inverse(const MatrixX& a) {
  return a.completeOrthogonalDecomposition().pseudoInverse();
}

MatrixX solve(const MatrixX& a, const MatrixX& b) {
  MatrixX x(b.rows(), b.cols());
  LuFactor(a).solve_columns(b, x);
  return x;
}

MatrixX solve_symmetric(const MatrixX& a, const MatrixX& b) { return a.ldlt().solve(b); }

}  // namespace sinew::linalg
