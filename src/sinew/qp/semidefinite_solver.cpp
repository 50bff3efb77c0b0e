#include "sinew/qp/semidefinite_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/core/types.hpp"

namespace sinew::qp {

namespace {

/// Proximal weights relative to the largest eigenvalue. The first is so small that a few steps
/// suffice, however far the point is and however limits couple the null space with the rest; it
/// costs half of the digits. Steps with the second one restore them.
constexpr double kLongSteps = 1e-8;
constexpr double kExactSteps = 1.0;
/// A gradient in the null space below this part of the whole one is rounding.
constexpr double kFlat = 1e-10;
/// Relative stationarity at which proximal steps end, and that which is accepted if they end early.
constexpr double kStationary = 1e-14;
constexpr double kAccepted = 1e-10;
/// Relative change of a limited quantity below which a direction does not change it.
constexpr double kRay = 1e-7;
constexpr int kMaxSteps = 60;

}  // namespace

SemidefiniteSolver::SemidefiniteSolver(int variables, int constraints, const QpSettings& settings)
    : variables_(variables),
      constraints_(constraints),
      eigen_(variables),
      scale_(VectorX::Ones(variables)),
      scaled_(variables, variables),
      gradient_(variables),
      point_(variables),
      step_(variables),
      proximal_(QuadraticProgram::sized(variables, constraints)),
      least_(QuadraticProgram::sized(variables, constraints + variables + 1)),
      proximal_solver_(variables, constraints, settings),
      least_solver_(variables, constraints + variables + 1, settings) {
  least_.hessian.setIdentity();
  found_.x.setZero(variables);
  found_.bound_multiplier.setZero(variables);
  found_.row_multiplier.setZero(constraints);
  found_.ray.setZero(variables);
}

bool SemidefiniteSolver::split(const QuadraticProgram& problem) {
  for (int i = 0; i < variables_; ++i) {
    const double diagonal = problem.hessian(i, i);
    scale_[i] = diagonal > 0.0 ? std::sqrt(diagonal) : 1.0;
  }
  for (int j = 0; j < variables_; ++j) {
    for (int i = j; i < variables_; ++i) {
      scaled_(i, j) = scaled_(j, i) = problem.hessian(i, j) / (scale_[i] * scale_[j]);
    }
  }
  eigen_.compute(scaled_);
  const VectorX& values = eigen_.values();
  largest_ = values[variables_ - 1] > 0.0 ? values[variables_ - 1] : 1.0;
  const double rounding = 32.0 * kEpsilon * variables_ * std::max(1.0, largest_);
  if (values[0] < -rounding) return false;
  nullity_ = 0;
  while (nullity_ < variables_ && values[nullity_] <= rounding) ++nullity_;
  return true;
}

void SemidefiniteSolver::load(const QuadraticProgram& problem) {
  const auto null_space = eigen_.vectors().leftCols(nullity_);
  gradient_ = problem.gradient.cwiseQuotient(scale_);
  const double whole = gradient_.norm();
  const double flat = (null_space.transpose() * gradient_).norm();
  falls_ = flat > kFlat * whole;
  if (!falls_) {
    for (int k = 0; k < nullity_; ++k) {
      gradient_ -= null_space.col(k).dot(gradient_) * null_space.col(k);
    }
  }
  proximal_.lower = problem.lower.cwiseProduct(scale_);
  proximal_.upper = problem.upper.cwiseProduct(scale_);
  for (int j = 0; j < variables_; ++j) proximal_.rows.col(j) = problem.rows.col(j) / scale_[j];
  proximal_.row_lower = problem.row_lower;
  proximal_.row_upper = problem.row_upper;
}

void SemidefiniteSolver::load_weight(double weight) {
  proximal_.hessian = scaled_;
  for (int k = 0; k < nullity_; ++k) {
    const auto direction = eigen_.vectors().col(k);
    for (int j = 0; j < variables_; ++j) {
      proximal_.hessian.col(j) += weight * direction[j] * direction;
    }
  }
}

// One proximal step from point_; writes the relative distance from stationarity.
QpStatus SemidefiniteSolver::take_step(double weight, double* stationarity) {
  const auto null_space = eigen_.vectors().leftCols(nullity_);
  proximal_.gradient = gradient_;
  for (int j = 0; j < nullity_; ++j) {
    proximal_.gradient -= weight * null_space.col(j).dot(point_) * null_space.col(j);
  }
  const int before = found_.iterations;
  const QpResult& next = proximal_solver_.solve(proximal_);
  if (next.status != QpStatus::optimal) return next.status;
  step_ = next.x - point_;
  double moved = 0.0;
  for (int j = 0; j < nullity_; ++j) moved = std::hypot(moved, null_space.col(j).dot(step_));
  point_ = next.x;
  found_ = next;
  found_.iterations += before;
  const double size = gradient_.norm() + largest_ * point_.norm();
  *stationarity = weight * moved / (size + std::numeric_limits<double>::min());
  return QpStatus::optimal;
}

QpStatus SemidefiniteSolver::approach() {
  point_.setZero();
  double stationarity = kInfinity;
  for (const double share : {kLongSteps, kExactSteps}) {
    load_weight(share * largest_);
    for (int k = 0; k < kMaxSteps; ++k) {
      const QpStatus status = take_step(share * largest_, &stationarity);
      if (status != QpStatus::optimal) return status;
      if (stationarity <= kStationary) break;
      if (share == kLongSteps && k > 0 && falls_ && is_ray(step_)) return QpStatus::unbounded;
    }
  }
  return stationarity <= kAccepted ? QpStatus::optimal : QpStatus::iteration_limit;
}

bool SemidefiniteSolver::is_ray(const VectorX& direction) const {
  const double length = direction.norm();
  if (!(length > 0.0) || !(gradient_.dot(direction) < 0.0)) return false;
  const double negligible = kRay * length;
  for (int k = nullity_; k < variables_; ++k) {
    if (std::abs(eigen_.vectors().col(k).dot(direction)) > negligible) return false;
  }
  for (int i = 0; i < variables_; ++i) {
    if (direction[i] < -negligible && proximal_.lower[i] > -kInfinity) return false;
    if (direction[i] > negligible && proximal_.upper[i] < kInfinity) return false;
  }
  for (int i = 0; i < constraints_; ++i) {
    const double change = proximal_.rows.row(i).dot(direction);
    const double allowed = negligible * proximal_.rows.row(i).norm();
    if (change < -allowed && proximal_.row_lower[i] > -kInfinity) return false;
    if (change > allowed && proximal_.row_upper[i] < kInfinity) return false;
  }
  return true;
}

void SemidefiniteSolver::lessen_effort() {
  least_.lower = proximal_.lower;
  least_.upper = proximal_.upper;
  least_.rows.topRows(constraints_) = proximal_.rows;
  least_.row_lower.head(constraints_) = proximal_.row_lower;
  least_.row_upper.head(constraints_) = proximal_.row_upper;
  const auto fix = [&](int row, bool held) {
    const int at = constraints_ + row;
    const double value = held ? least_.rows.row(at).dot(point_) : kInfinity;
    least_.row_lower[at] = held ? value : -kInfinity;
    least_.row_upper[at] = value;
  };
  for (int k = 0; k < variables_; ++k) {
    least_.rows.row(constraints_ + k) = eigen_.vectors().col(k).transpose();
    fix(k, k >= nullity_);
  }
  least_.rows.row(constraints_ + variables_) = gradient_.transpose();
  fix(variables_, falls_);
  const QpResult& least = least_solver_.solve(least_);
  // If rounding leaves no feasible point, the present optimal point is the only one.
  if (least.status == QpStatus::optimal) point_ = least.x;
}

void SemidefiniteSolver::write(const QuadraticProgram& problem, QpStatus status,
                               QpResult* result) const {
  result->status = status;
  result->iterations = found_.iterations;
  result->active = found_.active;
  result->x = point_.cwiseQuotient(scale_).cwiseMax(problem.lower).cwiseMin(problem.upper);
  result->bound_multiplier = found_.bound_multiplier.cwiseProduct(scale_);
  result->row_multiplier = found_.row_multiplier;
  for (int i = 0; i < variables_; ++i) {
    if (result->bound_multiplier[i] > 0.0) result->x[i] = problem.lower[i];
    if (result->bound_multiplier[i] < 0.0) result->x[i] = problem.upper[i];
  }
  if (status != QpStatus::unbounded) return;
  result->ray = step_.cwiseQuotient(scale_);
  result->ray /= result->ray.cwiseAbs().maxCoeff();
}

void SemidefiniteSolver::solve(const QuadraticProgram& problem, QpResult* result) {
  found_.iterations = found_.active = 0;
  found_.bound_multiplier.setZero();
  found_.row_multiplier.setZero();
  point_.setZero();
  QpStatus status = QpStatus::not_convex;
  if (split(problem)) {
    load(problem);
    status = approach();
  }
  if (status == QpStatus::optimal) lessen_effort();
  write(problem, status, result);
}

}  // namespace sinew::qp
