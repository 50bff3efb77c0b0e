#include "sinew/law/followers.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::law {

namespace {

// Relative to the robot's compliance: a flatter curve counts as a constant effort.
constexpr double kFlat = 1e-14;
// If held rows leave no motion, the rest of W is rounding of this relative size, of either sign.
constexpr double kRounding = 16.0 * kEpsilon;

}  // namespace

bool Followers::has_curves() const {
  return std::ranges::any_of(rows_, [](const Row& row) { return row.curve != nullptr; });
}

void Followers::factorise(const StepProblem& problem) {
  const auto count = static_cast<Eigen::Index>(rows_.size());
  own_.resize(count, count);
  scale_.resize(count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const Row& row = rows_[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < count; ++i) {
      own_(i, j) = problem.compliance(rows_[static_cast<std::size_t>(i)].row, row.row);
    }
    const double alone = std::abs(own_(j, j));  // an anchor's own W + C may vanish
    own_(j, j) += row.compliance;
    const double size = std::max(alone, std::abs(own_(j, j)));
    scale_[j] = size > 0.0 ? 1.0 / std::sqrt(size) : 0.0;
  }
  own_.array().colwise() *= scale_.array();
  own_.array().rowwise() *= scale_.transpose().array();
  factor_.compute(own_);
  singular_ = factor_.is_singular();
  if (singular_) inverse_ = linalg::spectral_inverse(own_).inverse;
}

void Followers::take_out(const StepProblem& problem, const VectorX& free,
                         std::span<const int> others, Eigen::Ref<MatrixX> compliance,
                         Eigen::Ref<VectorX> motion) {
  const auto count = static_cast<Eigen::Index>(rows_.size());
  const auto rest = static_cast<Eigen::Index>(others.size());
  for (Eigen::Index j = 0; j < rest; ++j) {
    const int column = others[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < rest; ++i) {
      compliance(i, j) = problem.compliance(others[static_cast<std::size_t>(i)], column);
    }
    motion[j] = free[column];
  }
  if (count == 0) return;
  for (Row& row : rows_) {
    if (row.curve == nullptr) continue;
    const auto at = row.curve->drive->respond(row.curve->drive_step, row.at);
    const double steepness =
        std::max(-at.slope, kFlat / std::abs(problem.compliance(row.row, row.row)));
    row.compliance = 1.0 / steepness;
    row.motion = row.at + row.compliance * at.effort;
  }
  factorise(problem);
  right_.resize(count, rest + 1);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < rest; ++j) {
      right_(i, j) = scale_[i] * problem.compliance(row.row, others[static_cast<std::size_t>(j)]);
    }
    right_(i, rest) = scale_[i] * (row.motion - free[row.row]);
  }
  if (singular_) {
    solved_.noalias() = inverse_ * right_;
  } else {
    solved_.resize(count, rest + 1);
    factor_.solve_columns(right_, solved_);
  }
  compliance.noalias() -= right_.leftCols(rest).transpose() * solved_.leftCols(rest);
  motion.noalias() += right_.leftCols(rest).transpose() * solved_.col(rest);
  const double share = kRounding * static_cast<double>(count);
  for (Eigen::Index j = 0; j < rest; ++j) {
    const int row = others[static_cast<std::size_t>(j)];
    if (std::abs(compliance(j, j)) > share * std::abs(problem.compliance(row, row))) {
      for (Eigen::Index i = j + 1; i < rest; ++i) compliance(j, i) = compliance(i, j);
    } else {
      compliance.col(j).setZero();
      compliance.row(j).setZero();
    }
  }
}

double Followers::close(const StepProblem& problem, const VectorX& free,
                        std::span<const int> others, std::span<double> effort) {
  const auto of = [&](int row) -> double& { return effort[static_cast<std::size_t>(row)]; };
  const auto rest = static_cast<Eigen::Index>(others.size());
  for (std::size_t d = 0; d < rows_.size(); ++d) {
    const auto i = static_cast<Eigen::Index>(d);
    double lambda = solved_(i, rest);
    for (Eigen::Index j = 0; j < rest; ++j) {
      lambda -= solved_(i, j) * of(others[static_cast<std::size_t>(j)]);
    }
    of(rows_[d].row) = scale_[i] * lambda;
  }
  double worst = 0.0;
  for (Row& row : rows_) {
    if (row.curve == nullptr) continue;
    double motion = free[row.row];
    for (const Row& other : rows_) motion += problem.compliance(row.row, other.row) * of(other.row);
    for (const int other : others) motion += problem.compliance(row.row, other) * of(other);
    const auto there = row.curve->drive->respond(row.curve->drive_step, motion);
    const double lambda = of(row.row);
    const double scale = std::max(std::abs(lambda), std::abs(there.effort)) +
                         std::abs(there.slope * motion) + 1e-300;
    worst = std::max(worst, std::abs(lambda - there.effort) / scale);
    row.at = motion;
  }
  return worst;
}

}  // namespace sinew::law
