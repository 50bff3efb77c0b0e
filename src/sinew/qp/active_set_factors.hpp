/// @file
/// Factors of a dual active-set method: J and R of Goldfarb and Idnani.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::qp {

/// Factors that are updated as the active set changes. With G = L L^T and N (n, q) the normals of
/// the active constraints, they are
///
///     J = L^-T Q  (n, n)   and   R  (q, q) upper triangular,   J^T N = [R; 0],
///
/// so that J J^T = G^-1, J1 (the first q columns) spans G^-1 N, and J2 (the rest) spans the
/// directions along which no active constraint changes. Normals are added by a Householder
/// reflection and removed by Givens rotations, in O(n^2) operations each. Allocates in the
/// constructor only.
/// Source: Goldfarb and Idnani, Math. Programming 27 (1983) 1-33, section 4.
class ActiveSetFactors {
 public:
  explicit ActiveSetFactors(int variables);

  /// Sets J = L^-T, with no active constraint. Reads the lower triangle of `hessian` (n, n).
  /// @return false if it is not positive definite to working precision.
  bool factorise(const MatrixX& hessian);

  int active() const { return active_; }

  /// Computes d = J^T normal, the first step of every operation with a constraint. `normal` has
  /// stride() entries; those from n on are zero.
  void project(const double* normal);
  /// The same for the unit vector e_i, the normal of a bound.
  void project_unit(int i);

  /// Computes z = J2 d2 (direction()) and r = R^-1 d1 (exchange()). If the multiplier of the
  /// projected constraint grows by t, x moves by t z and the multipliers of the active constraints
  /// by -t r.
  void compute_directions();
  const double* direction() const { return direction_.data(); }
  const double* exchange() const { return exchange_.data(); }
  /// d2|^2 = normal . z, and |d|^2. Their ratio measures the linear independence of the constraint.
  double independent_part() const { return independent_part_; }
  double whole_part() const { return whole_part_; }

  /// Makes the projected constraint the last active one. Requires compute_directions().
  void add();
  /// Removes the active constraint at `position`; later ones move forward by one.
  void drop(int position);

  /// Minimises 1/2 x^T G x + gradient^T x subject to N^T x = values. Writes x (stride()) and the
  /// multipliers (q) of G x + gradient = N multipliers.
  void solve_equality(const double* gradient, const double* values, double* x, double* multipliers);

  /// J^T v|, the norm of v (n) in the metric of G^-1.
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
