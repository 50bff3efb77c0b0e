/// @file
/// An iterative linear solver that the library does not know, and that does not count negative
/// eigenvalues.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include <Eigen/IterativeLinearSolvers>

#include "eigen_solvers.hpp"

namespace sinew::testing {

/// Conjugate gradients with a diagonal preconditioner. It knows of a matrix that is not positive
/// definite only what the diagonal shows.
class GradientSolver final : public linalg::LinearSolver {
 public:
  explicit GradientSolver(linalg::BlockPattern pattern) : pattern_(std::move(pattern)) {
    solver_.setTolerance(1e-13);
  }

  linalg::FactorStatus prepare(std::span<const double> matrix) override {
    matrix_ = lower_triangle(pattern_, matrix);
    solver_.compute(matrix_);
    const VectorX diagonal = matrix_.diagonal();
    if (!diagonal.allFinite() || diagonal.cwiseAbs().minCoeff() == 0.0) {
      return linalg::FactorStatus::singular;
    }
    return diagonal.minCoeff() < 0.0 ? linalg::FactorStatus::indefinite
                                     : linalg::FactorStatus::positive_definite;
  }
  void solve(std::span<const double> right, std::span<double> x, int count) override {
    const Eigen::Map<const MatrixX> b(right.data(), 3 * pattern_.nodes, count);
    Eigen::Map<MatrixX>(x.data(), b.rows(), count) = solver_.solve(b).eval();
  }
  std::size_t bytes() const override { return sizeof(double) * 3 * 3 * pattern_.row.size(); }

 private:
  linalg::BlockPattern pattern_;
  SparseMatrix matrix_;
  Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower> solver_;
};

/// Registers it before main() of a test program that includes this file.
inline const bool kGradientsRegistered = [] {
  register_solver<GradientSolver>("gradients", "Conjugate gradients, for tests.");
  return true;
}();

}  // namespace sinew::testing
