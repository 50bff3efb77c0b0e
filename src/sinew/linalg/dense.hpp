/// @file
/// Decompositions of dense matrices, compiled once: Eigen's templates cost seconds in every source
/// that names one. For matrices of up to a few hundred rows; nothing here is multithreaded.
/// Factors that are made anew in each step are in dense_factor.hpp.
#pragma once

#include <Eigen/Core>

#include "sinew/core/types.hpp"

namespace sinew::linalg {

/// Eigenvalues of a symmetric matrix, (n,) ascending, by tridiagonalisation and implicit QR (Golub
/// & Van Loan, Matrix Computations, 2013, sec. 8.3). @param a (n, n), n > 0; its lower triangle is
/// read.
VectorX symmetric_eigenvalues(const MatrixX& a);

/// A = U diag(values) V^T, for A of shape (m, n) and p = min(m, n).
struct Svd {
  VectorX values;  ///< (p,) descending
  MatrixX u;       ///< (m, p), (m, m) when full, empty when not asked for
  MatrixX v;       ///< (n, p), (n, n) when full, empty when not asked for
};

/// Singular vectors that svd() returns.
enum class SingularVectors { thin_u, thin_v, full_u, full_v };

/// Singular value decomposition by two-sided Jacobi rotations after a pivoted QR decomposition
/// (Golub & Van Loan 2013, sec. 8.6): small singular values too are accurate relative to their
/// size.
/// @param a (m, n), not empty. @param vectors the side that is wanted; the other stays empty.
Svd svd(const MatrixX& a, SingularVectors vectors);
/// Singular values alone, (p,) descending. @param a (m, n), not empty.
VectorX singular_values(const MatrixX& a);

/// Minimiser of |A x - b|, column by column.
struct LeastSquares {
  MatrixX x;              ///< (n, columns of b)
  Eigen::Index rank = 0;  ///< numerical rank of A; below n, x is one of many minimisers
};

/// Least squares by Householder QR with column pivoting (Golub & Van Loan 2013, sec. 5.4).
/// @param a (m, n), m >= n. @param b (m, k).
LeastSquares least_squares(const MatrixX& a, const MatrixX& b);
/// R of A = Q R, upper triangular, (n, n). @param a (m, n), m >= n.
MatrixX upper_factor(const MatrixX& a);
/// Moore-Penrose inverse, (n, m). @param a (m, n), of any rank.
MatrixX pseudo_inverse(const MatrixX& a);

/// x of A x = b by LU with partial pivoting. A singular A gives infinities or NaN.
/// @param a (n, n). @param b (n, k).
MatrixX solve(const MatrixX& a, const MatrixX& b);
/// x of A x = b for a symmetric A, by L D L^T with diagonal pivoting.
/// @param a (n, n), semidefinite of either sign; its lower triangle is read. @param b (n, k).
MatrixX solve_symmetric(const MatrixX& a, const MatrixX& b);

}  // namespace sinew::linalg
