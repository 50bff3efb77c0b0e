#include "sinew/high_rate/drive_program.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::high_rate {

namespace {

// Part of W's diagonal that is added to make the regularisation definite.
constexpr double kEvenly = 1e-6;
// Relative tolerance of limits of motions.
constexpr double kBlur = 1e-9;

double infinity_norm(const MatrixX& matrix) {
  double norm = 0.0;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    norm = std::max(norm, matrix.row(i).cwiseAbs().sum());
  }
  return norm;
}

}  // namespace

DriveProgram::DriveProgram(const HighRateSettings& settings)
    : settings_(settings),
      scale_(VectorX::Ones(static_cast<Eigen::Index>(settings.driven.size()))),
      jacobian_(MatrixX::Zero(static_cast<Eigen::Index>(settings.tasks.size()), scale_.size())),
      weighted_(jacobian_),
      residual_(VectorX::Zero(jacobian_.rows())),
      goal_(residual_),
      weight_(residual_),
      program_(qp::QuadraticProgram::sized(static_cast<int>(scale_.size()),
                                           static_cast<int>(scale_.size()))),
      solver_(static_cast<int>(scale_.size()), static_cast<int>(scale_.size())),
      elastic_(static_cast<int>(scale_.size()), static_cast<int>(scale_.size())) {}

// Calls visit(task, index, value without driven efforts, slope of a column) for tasks with a
// target.
template <typename Visit>
void DriveProgram::for_each_task(const Asked& asked, Visit&& visit) const {
  const TouchLaw& law = asked.law;
  for (std::size_t t = 0; t < settings_.tasks.size(); ++t) {
    const TaskRow& task = settings_.tasks[t];
    const auto k = static_cast<Eigen::Index>(t);
    if (!std::isfinite(asked.targets[k])) continue;
    const bool motion = task.kind == TaskKind::motion;
    const int hand = task.row - settings_.free_rows();
    const auto slope = [&](Eigen::Index column) {
      return motion ? law.compliance()(task.row, column) : law.touch_slope()(hand, column);
    };
    double value = motion ? law.free()[task.row] : law.touch_free()[hand];
    for (Eigen::Index j = 0; j < asked.unknown.size(); ++j) {
      value += slope(scale_.size() + j) * asked.unknown[j];
    }
    visit(task, k, value, slope);
  }
}

void DriveProgram::form_tasks(const Asked& asked) {
  weight_.setZero();
  residual_.setZero();
  jacobian_.setZero();
  for_each_task(asked, [&](const TaskRow& task, Eigen::Index k, double value, const auto& slope) {
    weight_[k] = task.weight;
    residual_[k] = value - goal_[k];
    for (Eigen::Index j = 0; j < scale_.size(); ++j) jacobian_(k, j) = scale_[j] * slope(j);
  });
}

double DriveProgram::missed(const Asked& asked, const VectorX& driven) const {
  double sum = 0.0;
  for_each_task(asked, [&](const TaskRow& task, Eigen::Index k, double value, const auto& slope) {
    for (Eigen::Index j = 0; j < driven.size(); ++j) value += slope(j) * driven[j];
    sum += 0.5 * task.weight * (value - goal_[k]) * (value - goal_[k]);
  });
  return sum;
}

// Shortens the targets of motions that are too far away for the linearisation, measured from its
// state. An angle counts as its arc at a distance of the robot's size.
void DriveProgram::shorten(const Asked& asked) {
  const Snapshot& snapshot = asked.snapshot;
  goal_ = asked.targets;
  const auto way = [&](std::size_t t) {
    const TaskRow& task = settings_.tasks[t];
    const double target = asked.targets[static_cast<Eigen::Index>(t)];
    if (task.kind != TaskKind::motion || task.weight == 0.0 || !std::isfinite(target)) return 0.0;
    const auto row = snapshot.compliance.row(task.row);
    return target - snapshot.free[task.row] - row.dot(snapshot.effort);
  };
  double square = 0.0;
  for (std::size_t t = 0; t < settings_.tasks.size(); ++t) {
    const double arc = (settings_.tasks[t].turns ? snapshot.size : 1.0) * way(t);
    square += arc * arc;
  }
  const double most = settings_.largest_step * snapshot.size;
  if (square <= most * most) return;
  const double rest = 1.0 - most / std::sqrt(square);
  for (std::size_t t = 0; t < settings_.tasks.size(); ++t) {
    goal_[static_cast<Eigen::Index>(t)] -= rest * way(t);
  }
}

void DriveProgram::regularise(const Asked& asked) {
  const MatrixX& w = asked.snapshot.compliance;
  const Eigen::Index count = scale_.size();
  const double wanted = infinity_norm(program_.hessian);
  double norm = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    norm = std::max(norm, scale_[i] * w.row(i).head(count).cwiseAbs().dot(scale_));
  }
  if (!(norm > 0.0)) norm = 1.0;
  const double eps = settings_.epsilon * (wanted > 0.0 ? wanted : norm) / norm;
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < count; ++i) {
      // Cables with friction make W unsymmetric: uses its symmetric part.
      double part = 0.5 * eps * scale_[i] * (w(i, j) + w(j, i)) * scale_[j];
      if (i == j) part = part > 0.0 ? (1.0 + kEvenly) * part : eps * norm;
      program_.hessian(i, j) += part;
      program_.gradient[i] -= part * asked.before[j] / scale_[j];
    }
  }
}

void DriveProgram::form_limits(const Asked& asked) {
  const Eigen::Index count = scale_.size();
  for (Eigen::Index k = 0; k < count; ++k) {
    const DrivenRow& row = settings_.driven[static_cast<std::size_t>(k)];
    const double most = row.effort_rate * settings_.period, before = asked.before[k];
    // An effort outside its limits returns to them at a limited rate.
    const double least = std::clamp(row.effort_min, before - most, before + most);
    const double largest = std::clamp(row.effort_max, before - most, before + most);
    program_.lower[k] = least / scale_[k];
    program_.upper[k] = largest / scale_[k];
    const auto compliance = asked.law.compliance().row(k);
    const double free =
        asked.law.free()[k] + compliance.tail(asked.unknown.size()).dot(asked.unknown);
    program_.row_lower[k] = row.motion_min - free;
    program_.row_upper[k] = row.motion_max - free;
    program_.rows.row(k) = compliance.head(count).cwiseProduct(scale_.transpose());
  }
}

bool DriveProgram::keeps_limits(const VectorX& driven) const {
  for (Eigen::Index k = 0; k < scale_.size(); ++k) {
    const DrivenRow& row = settings_.driven[static_cast<std::size_t>(k)];
    if (driven[k] < row.effort_min || driven[k] > row.effort_max) return false;
    double motion = 0.0, blur = 0.0;
    for (Eigen::Index j = 0; j < driven.size(); ++j) {
      const double part = program_.rows(k, j) * driven[j] / scale_[j];
      motion += part;
      blur += kBlur * std::abs(part);
    }
    if (motion < program_.row_lower[k] - blur || motion > program_.row_upper[k] + blur)
      return false;
  }
  return true;
}

DriveProgram::Status DriveProgram::solve(const Asked& asked, Eigen::Ref<VectorX> driven) {
  for (Eigen::Index k = 0; k < scale_.size(); ++k) {
    const double own = asked.snapshot.compliance(k, k);
    scale_[k] = own > 0.0 ? 1.0 / std::sqrt(own) : 1.0;
  }
  shorten(asked);
  form_tasks(asked);
  weighted_.noalias() = weight_.asDiagonal() * jacobian_;
  program_.hessian.noalias() = jacobian_.transpose() * weighted_;
  program_.gradient.noalias() = weighted_.transpose() * residual_;
  regularise(asked);
  form_limits(asked);
  const qp::QpResult& result = solver_.solve(program_);
  if (result.status == qp::QpStatus::optimal) {
    driven = result.x.cwiseProduct(scale_);
    return Status::solved;
  }
  if (result.status != qp::QpStatus::infeasible) return Status::failed;
  const qp::ElasticResult& nearest = elastic_.solve(program_);
  if (nearest.status != qp::ElasticStatus::optimal &&
      nearest.status != qp::ElasticStatus::relaxed) {
    return Status::failed;
  }
  driven = nearest.qp.x.cwiseProduct(scale_);
  return Status::limits_conflict;
}

}  // namespace sinew::high_rate
