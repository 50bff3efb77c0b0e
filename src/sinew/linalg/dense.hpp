/// @file
/// Decompositions of dense matrices, compiled once, since Eigen's templates cost seconds in every
/// source that uses them. They are meant for matrices of up to a few hundred rows and are
/// single-threaded. Factors that are recomputed in each step are in dense_factor.hpp.
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
  MatrixX u;       ///< (m, p), or (m, m) if full; empty unless requested
  MatrixX v;       ///< (n, p), or (n, n) if full; empty unless requested
};

/// Singular vectors that svd() returns.
enum class SingularVectors { thin_u, thin_v, full_u, full_v };

/// Singular value decomposition by two-sided Jacobi rotations after a pivoted QR decomposition
/// (Golub & Van Loan 2013, sec. 8.6). Small singular values are accurate relative to their size,
/// too.
/// @param a (m, n), not empty. @param vectors the requested side; the other stays empty.
Svd svd(const MatrixX& a, SingularVectors vectors);
/// Singular values only, (p,) descending. @param a (m, n), not empty.
VectorX singular_values(const MatrixX& a);

/// Minimisers of |A x - b| for each column of b.
struct LeastSquares {
  MatrixX x;              ///< (n, columns of b)
  Eigen::Index rank = 0;  ///< numerical rank of A; if below n, x is one of many minimisers
};

/// Least squares by Householder QR with column pivoting (Golub & Van Loan 2013, sec. 5.4).
/// @param a (m, n), m >= n. @param b (m, k).
LeastSquares least_squares(const MatrixX& a, const MatrixX& b);
/// R of A = Q R, upper triangular, (n, n). @param a (m, n), m >= n.
MatrixX upper_factor(const MatrixX& a);
/// Moore-Penrose inverse, (n, m). @param a (m, n), of any rank.
MatrixX pseudo_inverse(const MatrixX& a);

/// Solves A x = b by LU with partial pivoting. A singular A gives infinities or NaN.
/// @param a (n, n). @param b (n, k).
MatrixX solve(const MatrixX& a, const MatrixX& b);
/// Solves A x = b for a symmetric A by L D L^T with diagonal pivoting.
/// @param a (n, n), semidefinite of either sign; its lower triangle is read. @param b (n, k).
MatrixX solve_symmetric(const MatrixX& a, const MatrixX& b);

}  // namespace sinew::linalg
