#include "sinew/inverse/effort_program.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/inverse/limit_conflict.hpp"
#include "sinew/step/response.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::inverse {

namespace {

using step::ActuatorBlock;
using step::LawStatus;
using step::Response;
using step::StepProblem;

// Part of W's diagonal that makes the regularisation definite.
constexpr double kEvenly = 1e-6;
// A limit holds effectors back where it resists this part of what the gap could pull with.
constexpr double kHolds = 1e-3;

double infinity_norm(const MatrixX& matrix) { return matrix.cwiseAbs().rowwise().sum().maxCoeff(); }

}  // namespace

const ActuatorBlock& controlled_block(const StepProblem& problem, const Response& response,
                                      Eigen::Index k) {
  const int index = response.controlled()[static_cast<std::size_t>(k)];
  return problem.actuators[static_cast<std::size_t>(index)];
}

EffortProgram::EffortProgram(std::vector<int> rows, VectorX weights, int actuators)
    : rows_(std::move(rows)),
      weights_(std::move(weights)),
      jacobian_(MatrixX::Zero(weights_.size(), actuators)),
      weighted_(MatrixX::Zero(weights_.size(), actuators)),
      scale_(VectorX::Ones(actuators)),
      scaled_effort_(VectorX::Zero(actuators)),
      program_(qp::QuadraticProgram::sized(actuators, actuators)),
      solver_(actuators, actuators),
      elastic_(actuators, actuators),
      bound_multiplier_(VectorX::Zero(actuators)),
      row_multiplier_(VectorX::Zero(actuators)) {}

void EffortProgram::form_scales(const StepProblem& problem, const Response& response) {
  for (Eigen::Index k = 0; k < scale_.size(); ++k) {
    const ActuatorBlock& own = controlled_block(problem, response, k);
    const double yields = response.compliance()(own.row, k);
    const double limit = std::max(std::abs(own.effort_min), std::abs(own.effort_max));
    scale_[k] = std::isfinite(limit) && limit > 0.0 ? limit
                : yields > 0.0                      ? problem.size / (own.motion_scale * yields)
                                                    : 1.0;
  }
}

void EffortProgram::form(const StepProblem& problem, const Response& response,
                         const VectorX& residual, const EffortPull& pull) {
  form_scales(problem, response);
  const Eigen::Index count = scale_.size();
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const int row = controlled_block(problem, response, i).row;
      program_.rows(i, j) = scale_[j] * response.compliance()(row, j);
    }
    for (Eigen::Index k = 0; k < residual.size(); ++k) {
      const int row = rows_[static_cast<std::size_t>(k)];
      jacobian_(k, j) = scale_[j] * response.compliance()(row, j);
      weighted_(k, j) = weights_[k] * jacobian_(k, j);
    }
  }
  program_.hessian.noalias() = jacobian_.transpose() * weighted_;
  program_.gradient.noalias() = weighted_.transpose() * residual;
  regularise(problem, response, pull);
}

// Where friction slides R would be unsymmetric, and keeps its diagonal alone.
void EffortProgram::regularise(const StepProblem& problem, const Response& response,
                               const EffortPull& pull) {
  const Eigen::Index count = program_.gradient.size();
  double norm = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    norm = std::max(norm, std::abs(scale_[i]) * program_.rows.row(i).cwiseAbs().sum());
  }
  if (!(norm > 0.0)) norm = 1.0;
  const double asked = infinity_norm(program_.hessian);
  const double eps = pull.epsilon * (asked > 0.0 ? asked : norm) / norm;
  const double keep = pull.damping - pull.to_zero;
  const double stay = pull.damping_within - 1.0;
  for (Eigen::Index j = 0; j < count; ++j) {
    const int row = controlled_block(problem, response, j).row;
    const double before = problem.effort_before[static_cast<std::size_t>(row)] / scale_[j];
    for (Eigen::Index i = 0; i < count; ++i) {
      double weight = eps * scale_[i] * program_.rows(i, j);
      // What moves nothing is held by others: a drive, or the clamp.
      if (i == j) weight = weight > 0.0 ? (1.0 + kEvenly) * weight : eps * norm;
      if (i != j && response.is_unsymmetric()) weight = 0.0;
      program_.hessian(i, j) += (pull.damping + stay) * weight;
      program_.gradient[i] -= weight * (keep * before + stay * pull.last_choice[j] / scale_[j]);
    }
  }
}

void EffortProgram::form_limits(const StepProblem& problem, const Response& response) {
  for (Eigen::Index k = 0; k < scale_.size(); ++k) {
    const ActuatorBlock& own = controlled_block(problem, response, k);
    const double free = response.free()[own.row];
    program_.lower[k] = own.effort_min / scale_[k];
    program_.upper[k] = own.effort_max / scale_[k];
    program_.row_lower[k] = own.motion_min - free;
    program_.row_upper[k] = own.motion_max - free;
  }
}

LawStatus EffortProgram::solve(const sim::Model& model, const StepProblem& problem,
                               const Response& response, std::span<double> effort) {
  conflict_.clear();
  form_limits(problem, response);
  const qp::QpResult& result = solver_.solve(program_);
  if (result.status == qp::QpStatus::optimal) {
    scaled_effort_ = result.x;
    bound_multiplier_ = result.bound_multiplier;
    row_multiplier_ = result.row_multiplier;
    write(effort);
    return LawStatus::solved;
  }
  if (result.status != qp::QpStatus::infeasible) return LawStatus::failed;
  const qp::ElasticResult& nearest = elastic_.solve(program_);
  const bool usable =
      nearest.status == qp::ElasticStatus::optimal || nearest.status == qp::ElasticStatus::relaxed;
  if (!usable) return LawStatus::failed;
  scaled_effort_ = nearest.qp.x;
  write(effort);
  conflict_ = describe_conflict(model, response, program_, scale_, nearest);
  return LawStatus::limits_conflict;
}

void EffortProgram::write(std::span<double> effort) const {
  for (std::size_t k = 0; k < effort.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    effort[k] = scale_[i] * scaled_effort_[i];
  }
}

bool EffortProgram::limit_holds(double gap) const {
  for (Eigen::Index k = 0; k < scale_.size(); ++k) {
    const double most = kHolds * weighted_.col(k).norm() * gap;
    const double own = std::abs(program_.rows(k, k));
    if (std::abs(bound_multiplier_[k]) > most) return true;
    if (std::abs(row_multiplier_[k]) * own > most) return true;
  }
  return false;
}

void EffortProgram::reset() {
  solver_.reset();
  elastic_.reset();
}

void EffortProgram::forget() {
  reset();
  conflict_.clear();
}

}  // namespace sinew::inverse
