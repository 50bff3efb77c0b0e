/// @file
/// Factors of dense matrices that are recomputed in each step; they do not allocate after
/// construction.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "sinew/core/types.hpp"

namespace sinew::linalg {

/// LU factors P A = L U with partial pivoting. A singular A gives solutions that are not finite.
class LuFactor {
 public:
  explicit LuFactor(Eigen::Index size = 0) : lu_(size) {}
  explicit LuFactor(const MatrixX& a) : lu_(a.rows()) { compute(a); }

  /// @param a (size, size)
  void compute(const MatrixX& a);
  /// Solves A x = b. @param b (size,). @param x (size,), must not alias b.
  void solve(const Eigen::Ref<const VectorX>& b, Eigen::Ref<VectorX> x) const;
  /// Solves A^T x = b; allocates. @param b (size,). @param x (size,), must not alias b.
  void solve_transposed(const Eigen::Ref<const VectorX>& b, Eigen::Ref<VectorX> x) const;
  /// Solves for each column. @param b (size, k). @param x (size, k), must not alias b.
  void solve_columns(const Eigen::Ref<const MatrixX>& b, Eigen::Ref<MatrixX> x) const;
  /// Whether a pivot is zero to rounding, or not finite. A must be scaled to entries of order 1.
  bool is_singular() const;

 private:
  Eigen::PartialPivLU<MatrixX> lu_;
};

/// Cholesky factor A = L L^T of a positive definite A.
class CholeskyFactor {
 public:
  explicit CholeskyFactor(Eigen::Index size = 0) : llt_(size) {}

  /// @param a (size, size); its lower triangle is read. @return false if A is not positive
  ///   definite.
  bool compute(const MatrixX& a);
  /// Solves A x = b. @param b (size,). @param x (size,), may be b.
  void solve(const Eigen::Ref<const VectorX>& b, Eigen::Ref<VectorX> x) const;
  /// Solves for each column. @param b (size, k). @param x (size, k), may be b.
  void solve_columns(const Eigen::Ref<const MatrixX>& b, Eigen::Ref<MatrixX> x) const;

 private:
  Eigen::LLT<MatrixX> llt_;
};

/// Eigenvalues and eigenvectors of a symmetric matrix.
class SymmetricSpectrum {
 public:
  explicit SymmetricSpectrum(Eigen::Index size = 0) : solver_(size) {}
  explicit SymmetricSpectrum(const MatrixX& a) : solver_(a.rows()) { compute(a); }

  /// @param a (size, size); its lower triangle is read.
  void compute(const MatrixX& a);
  const VectorX& values() const { return solver_.eigenvalues(); }    ///< (size,) ascending
  const MatrixX& vectors() const { return solver_.eigenvectors(); }  ///< (size, size) columns

 private:
  Eigen::SelfAdjointEigenSolver<MatrixX> solver_;
};

/// Inertia of a symmetric matrix. With diagonal pivoting, P A P^T = L D L^T has positive D if A is
/// positive definite. Else it may break down, as for [0 1; 1 0], and the eigenvalues are computed.
class SymmetricPivots {
 public:
  explicit SymmetricPivots(Eigen::Index size = 0) : ldlt_(size), spectrum_(size) {}

  /// @param a (size, size); its lower triangle is read.
  void compute(const MatrixX& a);
  int negative() const { return negative_; }   ///< number of negative eigenvalues
  bool vanishes() const { return vanishes_; }  ///< whether A is singular to rounding

 private:
  Eigen::LDLT<MatrixX> ldlt_;
  SymmetricSpectrum spectrum_;
  int negative_ = 0;
  bool vanishes_ = false;
};

/// Pseudo-inverse of a symmetric matrix.
struct SpectralInverse {
  MatrixX inverse;   ///< Moore-Penrose, (n, n)
  int negative = 0;  ///< eigenvalues below zero
};
/// Computes a pseudo-inverse. Eigenvalues below 1e-11 of the largest, as from redundant rows, count
/// as zero. @param a (n, n), n > 0, scaled to entries of order 1; its lower triangle is read.
SpectralInverse spectral_inverse(const MatrixX& a);

}  // namespace sinew::linalg
