/// @file
/// A Factorisation on top of any LinearSolver.
#pragma once

#include <memory>

#include "sinew/linalg/factorisation.hpp"
#include "sinew/linalg/linear_solver.hpp"

namespace sinew::linalg {

/// Computes what a factorisation gives by solving for every row: X = A^-1 H^T, then W = H X and the
/// free motion X^T b. Costs a solution per row, where the bordered factorisation costs a part of
/// one.
class SolvedRows final : public Factorisation {
 public:
  /// @param border of the rows H. @param size number of coordinates. @param solver for their
  /// matrix.
  SolvedRows(std::shared_ptr<const BorderPattern> border, int size,
             std::unique_ptr<LinearSolver> solver);

  FactorStatus factorise(std::span<const double> matrix, std::span<const double> border,
                         std::span<const double> right) override;
  void release() override;
  void renew(std::span<const double> right) override;
  const MatrixX& compliance() const override { return compliance_; }
  const VectorX& free_motion() const override { return free_motion_; }
  double free_energy() const override { return free_energy_; }
  void solve_with_effort(std::span<const double> effort, std::span<double> x) override;
  void solve(std::span<const double> right, std::span<double> x, int count) override;
  void condense_transient(const BorderPattern& rows, std::span<const double> values) override;
  const MatrixX& transient_compliance() const override { return transient_compliance_; }
  const MatrixX& transient_coupling() const override { return transient_coupling_; }
  std::optional<int> negative_pivots() const override { return solver_->negative_pivots(); }
  std::size_t bytes() const override;

 private:
  void check_factor() const;
  void solve_columns(const MatrixX& right, MatrixX& x);

  std::shared_ptr<const BorderPattern> border_;
  std::unique_ptr<LinearSolver> solver_;
  MatrixX rows_, solved_rows_;    // (n, m) H^T and A^-1 H^T
  VectorX right_, solved_right_;  // (n,) b and A^-1 b
  MatrixX compliance_, transient_compliance_, transient_coupling_;
  VectorX free_motion_;
  double free_energy_ = 0.0;
  MatrixX transient_, solved_transient_;  // (n, 3 k) as above, of transient rows
  bool prepared_ = false;                 // since the last release()
};

}  // namespace sinew::linalg
