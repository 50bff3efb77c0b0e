/// @file
/// Linear solvers that the library does not know: Eigen's factorisations.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "sinew/linalg/factorisation.hpp"
#include "sinew/linalg/linear_solver.hpp"

namespace sinew::testing {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// The lower triangle of scalars of a matrix of blocks.
inline SparseMatrix lower_triangle(const linalg::BlockPattern& pattern,
                                   std::span<const double> values) {
  SparseMatrix matrix(3 * pattern.nodes, 3 * pattern.nodes);
  for (int j = 0; j < pattern.nodes; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (int c = 0; c < 3; ++c) {
      matrix.startVec(3 * j + c);
      for (int b = pattern.column_start[column]; b < pattern.column_start[column + 1]; ++b) {
        const int i = pattern.row[static_cast<std::size_t>(b)];
        for (int r = i == j ? c : 0; r < 3; ++r) {
          matrix.insertBack(3 * i + r, 3 * j + c) =
              values[static_cast<std::size_t>(linalg::kBlockStride * b + 4 * c + r)];
        }
      }
    }
  }
  matrix.finalize();
  return matrix;
}

/// Eigen's SimplicialLDLT.
class EigenSolver final : public linalg::LinearSolver {
 public:
  explicit EigenSolver(linalg::BlockPattern pattern) : pattern_(std::move(pattern)) {}

  linalg::FactorStatus prepare(std::span<const double> matrix) override {
    solver_.compute(lower_triangle(pattern_, matrix));
    if (solver_.info() != Eigen::Success) return linalg::FactorStatus::singular;
    const VectorX d = solver_.vectorD();
    negative_ = static_cast<int>((d.array() < 0).count());
    if (!(d.cwiseAbs().minCoeff() > 1e-14 * d.cwiseAbs().maxCoeff())) {
      return linalg::FactorStatus::singular;
    }
    return negative_ > 0 ? linalg::FactorStatus::indefinite
                         : linalg::FactorStatus::positive_definite;
  }
  void solve(std::span<const double> right, std::span<double> x, int count) override {
    const Eigen::Map<const MatrixX> b(right.data(), 3 * pattern_.nodes, count);
    Eigen::Map<MatrixX>(x.data(), b.rows(), count) = solver_.solve(b).eval();
  }
  std::optional<int> negative_pivots() const override { return negative_; }
  std::size_t bytes() const override { return sizeof(double) * 3 * 3 * pattern_.row.size(); }

 private:
  linalg::BlockPattern pattern_;
  Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> solver_;
  int negative_ = 0;
};

/// Eigen's SimplicialLLT, to which an indefinite matrix is singular.
class EigenCholesky final : public linalg::LinearSolver {
 public:
  explicit EigenCholesky(linalg::BlockPattern pattern) : pattern_(std::move(pattern)) {}

  linalg::FactorStatus prepare(std::span<const double> matrix) override {
    solver_.compute(lower_triangle(pattern_, matrix));
    return solver_.info() == Eigen::Success ? linalg::FactorStatus::positive_definite
                                            : linalg::FactorStatus::singular;
  }
  void solve(std::span<const double> right, std::span<double> x, int count) override {
    const Eigen::Map<const MatrixX> b(right.data(), 3 * pattern_.nodes, count);
    Eigen::Map<MatrixX>(x.data(), b.rows(), count) = solver_.solve(b).eval();
  }
  std::optional<int> negative_pivots() const override { return 0; }
  std::size_t bytes() const override { return sizeof(double) * 3 * 3 * pattern_.row.size(); }

 private:
  linalg::BlockPattern pattern_;
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> solver_;
};

/// Registers a solver. @param name,description in scenes.
template <class Solver>
void register_solver(const char* name, const char* description) {
  linalg::register_backend(
      {.name = name,
       .description = description,
       .make = [](const linalg::BlockPattern& pattern, const linalg::FactorisationSettings&,
                  ThreadPool&) { return std::make_unique<Solver>(pattern); }});
}

/// Registers both before main() of a test program that includes this file.
inline const bool kEigenRegistered = [] {
  register_solver<EigenSolver>("eigen-ldlt", "Eigen's SimplicialLDLT, for reference.");
  register_solver<EigenCholesky>("eigen-llt", "Eigen's SimplicialLLT, for reference.");
  return true;
}();

}  // namespace sinew::testing
