/// @file
/// Bounds and rows of a quadratic program as one numbered list of two-sided constraints.
#pragma once

#include "sinew/core/types.hpp"
#include "sinew/qp/quadratic_program.hpp"

namespace sinew::qp {

/// A numbered list of constraints: constraint c < n is the bound of x_c, constraint n + i is row i
/// of C. Each has a normal, two limits, and a weight 1 / |D^-1 normal| with D^2 = diag G, which
/// makes violations of constraints in different units comparable. Keeps a transposed copy of C, so
/// that normals are contiguous.
class ConstraintRows {
 public:
  ConstraintRows(int variables, int constraints);

  /// Loads the rows and limits of a problem. `problem` must outlive the use of this object. Throws
  /// Error: wrong-shape, contradictory-limits.
  /// @return false if a number is NaN, or infinite where it must be finite.
  bool load(const QuadraticProgram& problem);

  int count() const { return variables_ + constraints_; }
  bool is_bound(int c) const { return c < variables_; }
  double lower(int c) const { return lower_[c]; }
  double upper(int c) const { return upper_[c]; }
  bool is_equality(int c) const { return lower_[c] == upper_[c]; }
  double weight(int c) const { return weight_[c]; }
  /// sqrt(G_ii).
  double variable_scale(int i) const { return scale_[i]; }

  /// Normal of row constraint c >= n, padded to the stride of the columns.
  const double* normal(int c) const {
    return normals_.data() + static_cast<Eigen::Index>(c - variables_) * stride_;
  }

  /// normal . x, and sum |normal_j x_j|, to which its rounding errors are relative.
  double value(int c, const double* x) const;
  double magnitude(int c, const double* x) const;

  /// sum += factor times the normal of c.
  void add_normal(int c, double factor, double* sum) const;

 private:
  void check_shape(const QuadraticProgram& problem) const;
  void check_limits() const;

  int variables_ = 0;
  int constraints_ = 0;
  int stride_ = 0;
  VectorX normals_;        ///< C^T, column-major (stride, m)
  VectorX lower_, upper_;  ///< (n + m)
  VectorX weight_;         ///< (n + m)
  VectorX scale_;          ///< (n)
};

}  // namespace sinew::qp
