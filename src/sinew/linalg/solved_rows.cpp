#include "sinew/linalg/solved_rows.hpp"

#include <utility>

#include "sinew/core/error.hpp"

namespace sinew::linalg {

namespace {

// Columns of H^T. @param rows (n, m), overwritten.
void fill(const BorderPattern& pattern, std::span<const double> values, MatrixX& rows) {
  rows.setZero();
  for (int k = 0; k < pattern.rows(); ++k) {
    const auto row = static_cast<std::size_t>(k);
    for (auto e = pattern.row_start[row]; e < pattern.row_start[row + 1]; ++e) {
      const double* value = values.data() + 3 * static_cast<std::size_t>(e);
      rows.col(k).segment<3>(3 * pattern.node[static_cast<std::size_t>(e)]) =
          Eigen::Map<const Vector3>(value);
    }
  }
}

std::span<double> span_of(Eigen::PlainObjectBase<VectorX>& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

}  // namespace

SolvedRows::SolvedRows(std::shared_ptr<const BorderPattern> border, int size,
                       std::unique_ptr<LinearSolver> solver)
    : border_(std::move(border)),
      solver_(std::move(solver)),
      rows_(MatrixX::Zero(size, border_->rows())),
      solved_rows_(rows_),
      right_(VectorX::Zero(size)),
      solved_right_(right_),
      compliance_(MatrixX::Zero(border_->rows(), border_->rows())),
      free_motion_(VectorX::Zero(border_->rows())) {}

void SolvedRows::solve_columns(const MatrixX& right, MatrixX& x) {
  x.resize(right.rows(), right.cols());
  if (right.size() == 0) return;
  solver_->solve({right.data(), static_cast<std::size_t>(right.size())},
                 {x.data(), static_cast<std::size_t>(x.size())}, static_cast<int>(right.cols()));
}

// Rounding and the tolerance of an iterative solver leave W slightly unsymmetric.
FactorStatus SolvedRows::factorise(std::span<const double> matrix, std::span<const double> border,
                                   std::span<const double> right) {
  if (right_.size() == 0) return FactorStatus::positive_definite;
  const FactorStatus status = solver_->prepare(matrix);
  prepared_ = true;
  if (status == FactorStatus::singular) return status;
  fill(*border_, border, rows_);
  solve_columns(rows_, solved_rows_);
  compliance_.noalias() = rows_.transpose() * solved_rows_;
  compliance_ = (0.5 * (compliance_ + compliance_.transpose())).eval();
  renew(right);
  const bool solved = compliance_.allFinite() && solved_right_.allFinite();
  return solved ? status : FactorStatus::singular;
}

void SolvedRows::release() {
  prepared_ = false;
  solver_->release();
}

void SolvedRows::check_factor() const {
  if (prepared_) return;
  throw Error(ErrorKind::internal, {}, "a factor is asked for that was given back");
}

void SolvedRows::renew(std::span<const double> right) {
  if (right_.size() == 0) return;
  check_factor();
  right_ = Eigen::Map<const VectorX>(right.data(), right_.size());
  solver_->solve(right, span_of(solved_right_));
  free_motion_.noalias() = rows_.transpose() * solved_right_;
  free_energy_ = right_.dot(solved_right_);
}

void SolvedRows::solve_with_effort(std::span<const double> effort, std::span<double> x) {
  const Eigen::Map<const VectorX> lambda(effort.data(), rows_.cols());
  Eigen::Map<VectorX> result(x.data(), right_.size());
  result = solved_right_;
  result.noalias() += solved_rows_ * lambda;
}

void SolvedRows::solve(std::span<const double> right, std::span<double> x, int count) {
  if (right_.size() == 0) return;
  check_factor();
  solver_->solve(right, x, count);
}

void SolvedRows::condense_transient(const BorderPattern& pattern, std::span<const double> values) {
  check_factor();
  transient_.resize(right_.size(), pattern.rows());
  fill(pattern, values, transient_);
  solve_columns(transient_, solved_transient_);
  transient_compliance_.noalias() = transient_.transpose() * solved_transient_;
  transient_coupling_.resize(transient_.cols(), rows_.cols() + 1);
  transient_coupling_ << solved_transient_.transpose() * rows_,
      transient_.transpose() * solved_right_;
}

std::size_t SolvedRows::bytes() const {
  const Eigen::Index numbers = 2 * (rows_.size() + right_.size() + transient_.size()) +
                               compliance_.size() + transient_compliance_.size() +
                               transient_coupling_.size();
  return sizeof(double) * static_cast<std::size_t>(numbers) + solver_->bytes();
}

}  // namespace sinew::linalg
