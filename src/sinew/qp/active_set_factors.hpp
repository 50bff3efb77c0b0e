/// @file
/// The factors that a dual active-set method carries along: J and R of Goldfarb and Idnani.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::qp {

/// With G = L L^T and N (n, q) the normals of the active constraints, keeps
///
///     J = L^-T Q  (n, n)   and   R  (q, q) upper triangular,   J^T N = [R; 0],
///
/// so that J J^T = G^-1, J1 (the first q columns) spans G^-1 N, and J2 (the rest) spans the
/// directions in which no active constraint changes. Normals join by a Householder reflection and
/// leave by Givens rotations, each O(n^2). Allocates in the constructor only.
/// Source: Goldfarb and Idnani, Math. Programming 27 (1983) 1-33, section 4.
class ActiveSetFactors {
 public:
  explicit ActiveSetFactors(int variables);

  /// J = L^-T, no active constraint. Reads the lower triangle of `hessian` (n, n).
  /// @returns false when it is not positive definite to working precision.
  bool factorise(const MatrixX& hessian);

  int active() const { return active_; }

  /// d = J^T normal, the start of every operation with one constraint; `normal` has `stride()`
  /// entries, those from n on zero.
  void project(const double* normal);
  /// The same for the unit vector e_i, the normal of a bound.
  void project_unit(int i);

  /// z = J2 d2 (written to direction()) and r = R^-1 d1 (written to exchange()): when the
  /// multiplier of the projected constraint grows by t, x moves by t z and the multipliers of the
  /// active ones by -t r.
  void compute_directions();
  const double* direction() const { return direction_.data(); }
  const double* exchange() const { return exchange_.data(); }
  /// |d2|^2 = normal . z, and |d|^2: their ratio says how independent the constraint is.
  double independent_part() const { return independent_part_; }
  double whole_part() const { return whole_part_; }

  /// Makes the projected constraint the last active one; compute_directions() comes before.
  void add();
  /// Removes the active constraint at `position`; later ones move up by one.
  void drop(int position);

  /// Minimises 1/2 x^T G x + gradient^T x with N^T x = values:
  /// x (stride()) and the multipliers (q) of G x + gradient = N multipliers.
  void solve_equality(const double* gradient, const double* values, double* x, double* multipliers);

  /// |J^T v|, the length of v (n) in the metric of G^-1.
  double dual_norm(const double* v) const;

  /// Length of a column in memory: n rounded up to whole vector registers, padded with zeros.
  int stride() const { return stride_; }

 private:
  bool cholesky(const MatrixX& hessian);
  void invert_transpose();
  void multiply_transpose(const double* v, double* product) const;
  double* column(int j) { return basis_.data() + static_cast<Eigen::Index>(j) * stride_; }
  const double* column(int j) const {
    return basis_.data() + static_cast<Eigen::Index>(j) * stride_;
  }
  double* triangle(int j) { return triangle_.data() + static_cast<Eigen::Index>(j) * stride_; }
  const double* triangle(int j) const {
    return triangle_.data() + static_cast<Eigen::Index>(j) * stride_;
  }

  int size_ = 0;
  int stride_ = 0;
  int active_ = 0;
  double independent_part_ = 0.0;
  double whole_part_ = 0.0;
  VectorX lower_;       ///< L, column-major (stride, n)
  VectorX basis_;       ///< J, column-major (stride, n)
  VectorX triangle_;    ///< R, column-major (stride, n)
  VectorX projection_;  ///< d
  VectorX direction_;   ///< z
  VectorX exchange_;    ///< r
  VectorX scratch_;
};

}  // namespace sinew::qp
