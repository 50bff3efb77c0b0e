#include "sinew/control/effort_program.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/control/limit_conflict.hpp"
#include "sinew/law/response.hpp"
#include "sinew/law/step_problem.hpp"

namespace sinew::control {

namespace {

using law::ActuatorBlock;
using law::LawStatus;
using law::Response;
using law::StepProblem;

// Part of W's diagonal that is added to make the regularisation definite.
constexpr double kEvenly = 1e-6;
// A limit holds effectors back if its multiplier exceeds this part of the pull of the gap.
constexpr double kHolds = 1e-3;

// 1/2 x^T A x from the lower triangle of A, the only one that a program reads.
double half_square(const MatrixX& a, const VectorX& x) {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    sum += 0.5 * a(j, j) * x[j] * x[j];
    for (Eigen::Index i = j + 1; i < x.size(); ++i) sum += a(i, j) * x[i] * x[j];
  }
  return sum;
}

double infinity_norm(const MatrixX& matrix) { return matrix.cwiseAbs().rowwise().sum().maxCoeff(); }

}  // namespace

const ActuatorBlock& controlled_block(const StepProblem& problem, const Response& response,
                                      Eigen::Index k) {
  const int index = response.controlled()[static_cast<std::size_t>(k)];
  return problem.actuators[static_cast<std::size_t>(index)];
}

EffortProgram::EffortProgram(std::vector<int> rows, VectorX weights, int actuators,
                             ForceRows forces)
    : rows_(std::move(rows)),
      weights_(std::move(weights)),
      jacobian_(MatrixX::Zero(weights_.size(), actuators)),
      weighted_(MatrixX::Zero(weights_.size(), actuators)),
      scale_(VectorX::Ones(actuators)),
      scaled_effort_(VectorX::Zero(actuators)),
      forces_(std::move(forces)),
      pull_hessian_(MatrixX::Zero(actuators, actuators)),
      pull_gradient_(VectorX::Zero(actuators)),
      bound_multiplier_(VectorX::Zero(actuators)),
      row_multiplier_(VectorX::Zero(actuators)) {
  const int all = actuators + static_cast<int>(forces_.count());
  program_ = qp::QuadraticProgram::sized(all, all);
  solver_ = qp::QpSolver(all, all);
  elastic_ = qp::ElasticSolver(all, all);
}

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

void EffortProgram::begin(const StepProblem& problem, const Response& response,
                          const EffortPull& pull, double largest) {
  controlled_ = response.controlled();
  forces_.begin(problem, largest);
  form_scales(problem, response);
  form_rows(problem, response);
  regularise(problem, response, pull);
}

void EffortProgram::form_rows(const StepProblem& problem, const Response& response) {
  const Eigen::Index count = scale_.size();
  forces_.form(problem, response);
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const int row = controlled_block(problem, response, i).row;
      program_.rows(i, j) = scale_[j] * response.compliance()(row, j);
    }
    for (Eigen::Index k = 0; k < weights_.size(); ++k) {
      const int row = rows_[static_cast<std::size_t>(k)];
      jacobian_(k, j) = scale_[j] * response.compliance()(row, j);
      weighted_(k, j) = weights_[k] * jacobian_(k, j);
    }
  }
  for (Eigen::Index f = 0; f < forces_.count(); ++f) {
    program_.rows.row(count + f).head(count) =
        forces_.slope().row(f).cwiseProduct(scale_.transpose());
    program_.rows(count + f, count + f) = slack_scale_;
  }
}

void EffortProgram::form(const StepProblem& problem, const Response& response,
                         const VectorX& residual) {
  form_rows(problem, response);
  auto hessian = program_.hessian.topLeftCorner(scale_.size(), scale_.size());
  hessian.noalias() = jacobian_.transpose() * weighted_;
  hessian += pull_hessian_;
  auto gradient = program_.gradient.head(scale_.size());
  gradient.noalias() = weighted_.transpose() * residual;
  gradient += pull_gradient_;
  for (Eigen::Index f = scale_.size(); f < program_.gradient.size(); ++f) {
    program_.hessian(f, f) = forces_.weight() * slack_scale_ * slack_scale_;
  }
  left_ = 0.5 * residual.dot(weights_.cwiseProduct(residual));
}

// If friction slides, W_aa is unsymmetric; R then keeps its diagonal only.
void EffortProgram::regularise(const StepProblem& problem, const Response& response,
                               const EffortPull& pull) {
  const Eigen::Index count = scale_.size();
  double norm = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    norm = std::max(norm, std::abs(scale_[i]) * program_.rows.row(i).cwiseAbs().sum());
  }
  if (!(norm > 0.0)) norm = 1.0;
  pull_hessian_.noalias() = jacobian_.transpose() * weighted_;
  double asked = infinity_norm(pull_hessian_);
  if (!(asked > 0.0) && forces_.count() > 0) {
    const auto slope = program_.rows.bottomLeftCorner(forces_.count(), count);
    asked = forces_.weight() * slope.squaredNorm();
  }
  // Makes the curvatures along efforts and along slacks comparable.
  const bool compares = asked > 0.0 && forces_.count() > 0;
  slack_scale_ = compares ? std::sqrt(asked / forces_.weight()) : problem.size;
  const double eps = pull.epsilon * (asked > 0.0 ? asked : norm) / norm;
  // Where an effector is as far as an actuator can take it, W_ea goes to zero. The largest value so
  // far remains the measure of how far a step may go (More 1978, see StepDamping, section 6).
  largest_asked_ = std::max(largest_asked_, asked);
  const double stiffer = asked > 0.0 ? largest_asked_ / asked : 1.0;
  const double damps = stiffer * (pull.damping - 1.0);
  const double keep = damps + 1.0 - pull.to_zero;
  const double stay = stiffer * (pull.damping_within - 1.0);
  pull_gradient_.setZero();
  for (Eigen::Index j = 0; j < count; ++j) {
    const int row = controlled_block(problem, response, j).row;
    const double before = problem.effort_before[static_cast<std::size_t>(row)] / scale_[j];
    for (Eigen::Index i = 0; i < count; ++i) {
      double weight = eps * scale_[i] * program_.rows(i, j);
      // An effort that moves nothing is held by a drive or a clamp.
      if (i == j) weight = weight > 0.0 ? (1.0 + kEvenly) * weight : eps * norm;
      if (i != j && response.is_unsymmetric()) weight = 0.0;
      pull_hessian_(i, j) = (1.0 + damps + stay) * weight;
      pull_gradient_[i] -= weight * (keep * before + stay * pull.last_choice[j] / scale_[j]);
    }
  }
}

double EffortProgram::pull_value(std::span<const double> effort) const {
  scaled_trial_ = Eigen::Map<const VectorX>(effort.data(), scale_.size()).cwiseQuotient(scale_);
  return pull_gradient_.dot(scaled_trial_) + half_square(pull_hessian_, scaled_trial_);
}

double EffortProgram::excess(const StepProblem& problem, const VectorX& motion,
                             std::span<const double> effort) const {
  double farthest = 0.0;
  for (std::size_t k = 0; k < controlled_.size(); ++k) {
    const ActuatorBlock& own = problem.actuators[static_cast<std::size_t>(controlled_[k])];
    const double scale = std::abs(scale_[static_cast<Eigen::Index>(k)]);
    const double delta = own.motion_scale * motion[own.row] / problem.size;
    const double least = own.motion_scale * own.motion_min / problem.size;
    const double most = own.motion_scale * own.motion_max / problem.size;
    farthest = std::max({farthest, (own.effort_min - effort[k]) / scale,
                         (effort[k] - own.effort_max) / scale, least - delta, delta - most});
  }
  return farthest;
}

void EffortProgram::form_limits(const StepProblem& problem, const Response& response,
                                qp::QuadraticProgram& program) const {
  form_forces(program);
  for (Eigen::Index k = 0; k < scale_.size(); ++k) {
    const ActuatorBlock& own = controlled_block(problem, response, k);
    const double free = response.free()[own.row];
    program.lower[k] = own.effort_min / scale_[k];
    program.upper[k] = own.effort_max / scale_[k];
    program.row_lower[k] = own.motion_min - free;
    program.row_upper[k] = own.motion_max - free;
  }
}

void EffortProgram::form_forces(qp::QuadraticProgram& program) const {
  const Eigen::Index rows = forces_.count();
  program.row_lower.segment(scale_.size(), rows) = forces_.lower() - forces_.offset();
  program.row_upper.segment(scale_.size(), rows) = forces_.upper() - forces_.offset();
}

// Allocates more guard rows than needed; the others are empty.
LawStatus EffortProgram::solve_guarded(const StepProblem& problem, const Response& response,
                                       bool tight, std::span<double> effort) {
  const Eigen::Index count = program_.gradient.size();
  const auto guards = static_cast<Eigen::Index>(response.guards().size());
  if (guarded_.rows.rows() < count + guards || guarded_.gradient.size() != count) {
    // A multiple of the widest vectors, so that the number of empty rows changes no bit of the
    // result.
    const auto rows = static_cast<int>((count + guards + guards / 2 + 32) / 16 * 16);
    guarded_ = qp::QuadraticProgram::sized(static_cast<int>(count), rows);
    guarded_solver_ = qp::QpSolver(static_cast<int>(count), rows);
  }
  guarded_.hessian = program_.hessian;
  guarded_.gradient = program_.gradient;
  guarded_.rows.topRows(count) = program_.rows;
  form_limits(problem, response, guarded_);
  guarded_.rows.bottomRows(guarded_.rows.rows() - count).setZero();
  guarded_.row_lower.tail(guarded_.rows.rows() - count).setConstant(-kInfinity);
  guarded_.row_upper.tail(guarded_.rows.rows() - count).setConstant(kInfinity);
  for (Eigen::Index g = 0; g < guards; ++g) {
    const auto number = static_cast<std::size_t>(g);
    guarded_.rows.row(count + g).head(scale_.size()) =
        response.guard_slope(number).cwiseProduct(scale_).transpose();
    const law::Guard& guard = response.guards()[number];
    guarded_.row_lower[count + g] = -guard.offset;
    if (tight && guard.tight) guarded_.row_upper[count + g] = -guard.offset;
  }
  const qp::QpResult& result = guarded_solver_.solve(guarded_);
  if (result.status != qp::QpStatus::optimal) return LawStatus::failed;
  keep(result);
  const double* first = result.row_multiplier.data() + count;
  guard_multipliers_.assign(first, first + guards);
  write(effort);
  return LawStatus::solved;
}

void EffortProgram::keep(const qp::QpResult& result) {
  scaled_effort_ = result.x;
  bound_multiplier_ = result.bound_multiplier;
  row_multiplier_ = result.row_multiplier.head(scale_.size());
  foreseen_ = left_ + program_.gradient.dot(result.x) + half_square(program_.hessian, result.x);
}

LawStatus EffortProgram::solve(const model::Model& model, const StepProblem& problem,
                               const Response& response, std::span<double> effort) {
  conflict_.clear();
  form_limits(problem, response, program_);
  const qp::QpResult& result = solver_.solve(program_);
  if (result.status == qp::QpStatus::optimal) {
    keep(result);
    write(effort);
    return LawStatus::solved;
  }
  if (result.status != qp::QpStatus::infeasible) return LawStatus::failed;
  const qp::ElasticResult& nearest = elastic_.solve(program_);
  // An unfinished solution meets the limits of efforts.
  const bool usable = nearest.status == qp::ElasticStatus::optimal ||
                      nearest.status == qp::ElasticStatus::relaxed ||
                      nearest.status == qp::ElasticStatus::iteration_limit;
  if (!usable) return LawStatus::failed;
  scaled_effort_ = nearest.qp.x;
  foreseen_ = kInfinity;
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
  guarded_solver_.reset();
  elastic_.reset();
}

void EffortProgram::forget() {
  reset();
  largest_asked_ = 0.0;
  conflict_.clear();
}

}  // namespace sinew::control
