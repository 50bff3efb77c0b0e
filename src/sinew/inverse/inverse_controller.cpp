#include "sinew/inverse/inverse_controller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/core/error.hpp"
#include "sinew/inverse/limit_conflict.hpp"
#include "sinew/sim/actuator.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/step/response.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::inverse {

namespace {

using step::ActuatorBlock;
using step::LawStatus;
using step::Response;
using step::StepProblem;

// A limit is taken to bind when the solution comes this near, relative to its size.
constexpr double kActive = 1e-9;
// Part of W's diagonal that makes the regularisation definite.
constexpr double kEvenly = 1e-6;
// At rest nothing moves by more than this part of the tolerance in a step, so that what still
// creeps towards an optimum goes less than a hundredth of the tolerance in fifty steps.
constexpr double kStill = 2e-4;
// And forces balance to this part of their size.
constexpr double kBalanced = 1e-3;
// A limit holds effectors back where it resists this part of what the gap could pull with.
constexpr double kHolds = 1e-3;

bool near(double value, double limit) {
  return std::isfinite(limit) && std::abs(value - limit) <= kActive * (1.0 + std::abs(limit));
}

double infinity_norm(const MatrixX& matrix) { return matrix.cwiseAbs().rowwise().sum().maxCoeff(); }

}  // namespace

InverseController::InverseController(sim::Simulation& simulation, InverseSettings settings)
    : simulation_(simulation), settings_(std::move(settings)) {
  const sim::Model& model = simulation_.model();
  check_settings(simulation_, settings_);
  std::vector<double> weights;
  for (const Task& task : settings_.tasks) {
    const auto& effector = model.effector(task.effector);
    for (int k = 0; k < effector.row_count(); ++k) {
      effector_rows_.push_back(effector.first_row() + k);
      weights.push_back(task.weight(k));
    }
  }
  const auto rows = static_cast<Eigen::Index>(effector_rows_.size());
  const auto count = static_cast<Eigen::Index>(settings_.actuators.size());
  row_weights_ = Eigen::Map<VectorX>(weights.data(), rows);
  jacobian_.setZero(rows, count);
  weighted_.setZero(rows, count);
  residual_.setZero(rows);
  gap_.setZero(rows);
  gap_before_.setZero(rows);
  for_later_.setZero(rows);
  foreseen_.setZero(rows);
  asked_.assign(settings_.tasks.size(), Vector3::Zero());
  bound_multiplier_.setZero(count);
  row_multiplier_.setZero(count);
  scale_.setOnes(count);
  scaled_effort_.setZero(count);
  program_ = qp::QuadraticProgram::sized(static_cast<int>(count), static_cast<int>(count));
  solver_ = qp::QpSolver(static_cast<int>(count), static_cast<int>(count));
  elastic_ = qp::ElasticSolver(static_cast<int>(count), static_cast<int>(count));
  efforts_.setZero(count);
  last_choice_.setZero(count);
  gap_linearised_.setZero(rows);
  simulation_.attach(*this, settings_.actuators);
  attached_ = true;
}

InverseController::~InverseController() { detach(); }

void InverseController::detach() {
  if (attached_) simulation_.detach(*this);
  attached_ = false;
}

InverseStatus InverseController::step() {
  simulation_.step();
  return status_;
}

void InverseController::set_target(int task, Target target) {
  check_target(simulation_, settings_.tasks.at(static_cast<std::size_t>(task)).effector, target);
  settings_.tasks.at(static_cast<std::size_t>(task)).target = std::move(target);
}

// Of a step, whose law may be solved several times. First: what became of the step before, and what
// is asked in this one. Later: what became of the last choice, where the robot has been linearised
// anew since.
void InverseController::look_back(const StepProblem& problem) {
  if (!(problem.time > time_)) return review_choice(problem);
  inner_damping_.set(1.0);
  tried_ = false;
  if (std::isfinite(time_)) {
    measure_gap(problem);
    surprise_ = 0.0;
    for (Eigen::Index k = 0; k < gap_.size(); ++k) {
      if (row_weights_[k] > 0.0) surprise_ = std::hypot(surprise_, gap_[k] - foreseen_[k]);
    }
    damping_.review(objective(gap_before_), objective(foreseen_), objective(gap_),
                    negligible_objective());
  }
  time_ = problem.time;
  for (std::size_t t = 0; t < asked_.size(); ++t) asked_[t] = settings_.tasks[t].target.at(time_);
  measure_gap(problem);
  gap_before_ = gap_;
  gap_linearised_ = gap_;
}

// Within a step the damping only grows: choices that go back and forth come to rest.
void InverseController::review_choice(const StepProblem& problem) {
  if (!tried_) return;
  measure_gap(problem);
  const double least = inner_damping_.value();
  inner_damping_.review(objective(gap_linearised_), objective(foreseen_), objective(gap_),
                        negligible_objective());
  inner_damping_.set(std::max(least, inner_damping_.value()));
  gap_linearised_ = gap_;
  tried_ = false;
}

void InverseController::measure_gap(const StepProblem& problem) {
  Eigen::Index at = 0;
  for (std::size_t t = 0; t < asked_.size(); ++t) {
    const auto& effector = simulation_.model().effector(settings_.tasks[t].effector);
    effector.target_delta(simulation_.configuration(), asked_[t],
                          gap_.segment(at, effector.row_count()));
    at += effector.row_count();
  }
  for (Eigen::Index k = 0; k < gap_.size(); ++k) {
    gap_[k] -= problem.delta[effector_rows_[static_cast<std::size_t>(k)]];
  }
}

double InverseController::objective(const VectorX& gap) const {
  return 0.5 * gap.dot(row_weights_.cwiseProduct(gap));
}

double InverseController::negligible_objective() const {
  const double still = kStill * settings_.tolerance;
  return 0.5 * row_weights_.maxCoeff() * still * still;
}

// However often the step is linearised, its goal stays: the part of the gap at its start that one
// step may close.
void InverseController::form_residual(const StepProblem& problem, const Response& response) {
  measure_gap(problem);
  double to_go = 0.0;
  for (Eigen::Index k = 0; k < gap_.size(); ++k) {
    if (row_weights_[k] > 0.0) to_go = std::hypot(to_go, gap_before_[k]);
  }
  const double most = settings_.largest_step * problem.size;
  for_later_ = (1.0 - (to_go > most ? most / to_go : 1.0)) * gap_before_;
  for (Eigen::Index k = 0; k < residual_.size(); ++k) {
    const int row = effector_rows_[static_cast<std::size_t>(k)];
    residual_[k] = response.free()[row] - problem.delta[row] - (gap_[k] - for_later_[k]);
  }
}

const ActuatorBlock& InverseController::block(const StepProblem& problem, const Response& response,
                                              Eigen::Index k) {
  const int index = response.controlled()[static_cast<std::size_t>(k)];
  return problem.actuators[static_cast<std::size_t>(index)];
}

void InverseController::form_scales(const StepProblem& problem, const Response& response) {
  for (Eigen::Index k = 0; k < scale_.size(); ++k) {
    const ActuatorBlock& own = block(problem, response, k);
    const double yields = response.compliance()(own.row, k);
    const double limit = std::max(std::abs(own.effort_min), std::abs(own.effort_max));
    scale_[k] = std::isfinite(limit) && limit > 0.0 ? limit
                : yields > 0.0                      ? problem.size / (own.motion_scale * yields)
                                                    : 1.0;
  }
}

void InverseController::form_objective(const StepProblem& problem, const Response& response) {
  form_scales(problem, response);
  const Eigen::Index count = scale_.size();
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const int row = block(problem, response, i).row;
      program_.rows(i, j) = scale_[j] * response.compliance()(row, j);
    }
    for (Eigen::Index k = 0; k < residual_.size(); ++k) {
      const int row = effector_rows_[static_cast<std::size_t>(k)];
      jacobian_(k, j) = scale_[j] * response.compliance()(row, j);
      weighted_(k, j) = row_weights_[k] * jacobian_(k, j);
    }
  }
  program_.hessian.noalias() = jacobian_.transpose() * weighted_;
  program_.gradient.noalias() = weighted_.transpose() * residual_;
  regularise(problem, response);
}

// With p the pull to zero efforts, d the damping, and c that within the step, adds
//   eps/2 (d lambda^T R lambda - 2 (d - p) lambda^T R lambda_0
//          + (c - 1) (lambda - lambda_1)^T R (lambda - lambda_1)),
// with lambda_1 the step's last choice. At lambda = lambda_0 and lambda = lambda_1 the derivative
// is that of p eps/2 lambda^T R lambda: neither d nor c moves a fixed point. Where friction slides
// R would be unsymmetric, and keeps its diagonal alone.
void InverseController::regularise(const StepProblem& problem, const Response& response) {
  const Eigen::Index count = program_.gradient.size();
  double norm = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    norm = std::max(norm, std::abs(scale_[i]) * program_.rows.row(i).cwiseAbs().sum());
  }
  if (!(norm > 0.0)) norm = 1.0;
  const double asked = infinity_norm(program_.hessian);
  const double eps = settings_.epsilon * (asked > 0.0 ? asked : norm) / norm;
  const bool change = settings_.regularisation == Regularisation::change;
  const double damping = damping_.value();
  const double keep = damping - (change ? settings_.relaxation : 1.0);
  const double stay = inner_damping_.value() - 1.0;
  for (Eigen::Index j = 0; j < count; ++j) {
    const int row = block(problem, response, j).row;
    const double before = problem.effort_before[static_cast<std::size_t>(row)] / scale_[j];
    for (Eigen::Index i = 0; i < count; ++i) {
      double weight = eps * scale_[i] * program_.rows(i, j);
      // What moves nothing is held by others: a drive, or the clamp.
      if (i == j) weight = weight > 0.0 ? (1.0 + kEvenly) * weight : eps * norm;
      if (i != j && response.is_unsymmetric()) weight = 0.0;
      program_.hessian(i, j) += (damping + stay) * weight;
      program_.gradient[i] -= weight * (keep * before + stay * last_choice_[j] / scale_[j]);
    }
  }
}

void InverseController::form_limits(const StepProblem& problem, const Response& response) {
  for (Eigen::Index k = 0; k < scale_.size(); ++k) {
    const ActuatorBlock& own = block(problem, response, k);
    const double free = response.free()[own.row];
    program_.lower[k] = own.effort_min / scale_[k];
    program_.upper[k] = own.effort_max / scale_[k];
    program_.row_lower[k] = own.motion_min - free;
    program_.row_upper[k] = own.motion_max - free;
  }
}

LawStatus InverseController::solve_program(const StepProblem& problem, const Response& response) {
  form_limits(problem, response);
  const qp::QpResult& result = solver_.solve(program_);
  if (result.status == qp::QpStatus::optimal) {
    scaled_effort_ = result.x;
    bound_multiplier_ = result.bound_multiplier;
    row_multiplier_ = result.row_multiplier;
    return LawStatus::solved;
  }
  if (result.status != qp::QpStatus::infeasible) return LawStatus::failed;
  const qp::ElasticResult& nearest = elastic_.solve(program_);
  const bool usable =
      nearest.status == qp::ElasticStatus::optimal || nearest.status == qp::ElasticStatus::relaxed;
  if (!usable) return LawStatus::failed;
  scaled_effort_ = nearest.qp.x;
  conflict_ = describe_conflict(simulation_.model(), response, program_, scale_, nearest);
  return LawStatus::limits_conflict;
}

LawStatus InverseController::choose(const StepProblem& problem, const Response& response,
                                    std::span<double> effort) {
  look_back(problem);
  form_residual(problem, response);
  form_objective(problem, response);
  conflict_.clear();
  const LawStatus status = solve_program(problem, response);
  if (status == LawStatus::failed) return status;
  for (std::size_t k = 0; k < effort.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    effort[k] = scale_[i] * scaled_effort_[i];
  }
  return status;
}

double InverseController::miss(const StepProblem& problem, const VectorX& motion) const {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < gap_.size(); ++k) {
    const int row = effector_rows_[static_cast<std::size_t>(k)];
    const double left = motion[row] - problem.delta[row] - (gap_[k] - for_later_[k]);
    sum += row_weights_[k] * left * left;
  }
  return std::sqrt(sum / row_weights_.maxCoeff());
}

double InverseController::negligible_miss() const { return kStill * settings_.tolerance; }

void InverseController::accept(const StepProblem& problem, const Response& response,
                               const VectorX& motion, std::span<const double> effort) {
  tried_ = true;
  last_choice_ = Eigen::Map<const VectorX>(effort.data(), std::ssize(effort));
  for (std::size_t k = 0; k < effort.size(); ++k) {
    const auto place = std::ranges::find(settings_.actuators, response.controlled()[k]);
    efforts_[place - settings_.actuators.begin()] = effort[k];
  }
  const double moved = foresee(problem, response, motion);
  status_ = conflict_.empty() ? judge(problem, response, motion, effort, moved)
                              : InverseStatus::limits_conflict;
}

// What the linearisation says of the step's end: the gaps that stay, and the farthest that an
// effector or an actuator moves in the step, m.
double InverseController::foresee(const StepProblem& problem, const Response& response,
                                  const VectorX& motion) {
  double moved = 0.0;
  predicted_error_ = 0.0;
  for (Eigen::Index k = 0; k < gap_.size(); ++k) {
    const int row = effector_rows_[static_cast<std::size_t>(k)];
    foreseen_[k] = gap_[k] - (motion[row] - problem.delta[row]);
    moved = std::max(moved, std::abs(gap_before_[k] - foreseen_[k]));
    if (row_weights_[k] > 0.0) predicted_error_ = std::hypot(predicted_error_, foreseen_[k]);
  }
  for (Eigen::Index k = 0; k < scale_.size(); ++k) {
    const ActuatorBlock& own = block(problem, response, k);
    const int index = response.controlled()[static_cast<std::size_t>(k)];
    const double change = motion[own.row] - simulation_.actuator(index).motion;
    moved = std::max(moved, own.motion_scale * std::abs(change));
  }
  return moved;
}

InverseStatus InverseController::judge(const StepProblem& problem, const Response& response,
                                       const VectorX& motion, std::span<const double> effort,
                                       double moved) const {
  if (predicted_error_ <= settings_.tolerance) {
    return surprise_ <= settings_.tolerance ? InverseStatus::on_target : InverseStatus::moving;
  }
  if (rate_binds(problem, response, motion, effort)) return InverseStatus::rate_limited;
  // A step that was damped would have gone so much farther.
  const bool still = moved * damping_.value() <= kStill * settings_.tolerance;
  const bool rests = still && surprise_ <= settings_.tolerance &&
                     simulation_.report().relative_residual <= kBalanced;
  if (!rests) return InverseStatus::moving;
  return limit_holds() ? InverseStatus::out_of_reach : InverseStatus::local_optimum;
}

bool InverseController::rate_binds(const StepProblem& problem, const Response& response,
                                   const VectorX& motion, std::span<const double> effort) const {
  for (Eigen::Index k = 0; k < scale_.size(); ++k) {
    const ActuatorBlock& own = block(problem, response, k);
    const auto index = static_cast<std::size_t>(response.controlled()[static_cast<std::size_t>(k)]);
    const auto& model = simulation_.model().actuators()[index];
    const double lambda = effort[static_cast<std::size_t>(k)], delta = motion[own.row];
    const bool binds = (own.effort_max < model.effort.max && near(lambda, own.effort_max)) ||
                       (own.effort_min > model.effort.min && near(lambda, own.effort_min)) ||
                       (own.motion_max < model.motion.max && near(delta, own.motion_max)) ||
                       (own.motion_min > model.motion.min && near(delta, own.motion_min));
    if (binds) return true;
  }
  return false;
}

// By the multipliers of its limits.
bool InverseController::limit_holds() const {
  const double gap = foreseen_.norm();
  for (Eigen::Index k = 0; k < scale_.size(); ++k) {
    const double most = kHolds * weighted_.col(k).norm() * gap;
    const double own = std::abs(program_.rows(k, k));
    if (std::abs(bound_multiplier_[k]) > most) return true;
    if (std::abs(row_multiplier_[k]) * own > most) return true;
  }
  return false;
}

void InverseController::begin_step() {
  solver_.reset();
  elastic_.reset();
}

// All that a step leaves to the next one, but for what infinity says.
template <class Self, class Visitor>
void InverseController::visit_memory(Self& self, Visitor&& visitor) {
  for (auto& target : self.asked_) {
    for (Eigen::Index k = 0; k < 3; ++k) visitor(target[k]);
  }
  for (auto& gap : self.gap_before_) visitor(gap);
  for (auto& gap : self.foreseen_) visitor(gap);
  for (auto& effort : self.efforts_) visitor(effort);
}

// Infinite and undefined numbers stand for "not yet known": before the first step and after it.
void InverseController::forget() {
  begin_step();
  damping_.set(1.0);
  time_ = -std::numeric_limits<double>::infinity();
  surprise_ = std::numeric_limits<double>::infinity();
  predicted_error_ = std::numeric_limits<double>::quiet_NaN();
  status_ = InverseStatus::not_started;
  conflict_.clear();
  visit_memory(*this, [](double& number) { number = 0.0; });
}

// Then: the steps known (0, 1, or 2 for two and more), time, surprise, prediction, damping, status.
constexpr std::size_t kKnown = 6;

std::size_t InverseController::memory_size() const {
  std::size_t size = kKnown;
  visit_memory(*this, [&](double) { ++size; });
  return size;
}

void InverseController::save_memory(std::span<double> memory) const {
  const bool started = std::isfinite(time_), judged = started && std::isfinite(surprise_);
  const double known[kKnown] = {static_cast<double>(started) + static_cast<double>(judged),
                                started ? time_ : 0.0,
                                judged ? surprise_ : 0.0,
                                started ? predicted_error_ : 0.0,
                                damping_.value(),
                                static_cast<double>(status_)};
  std::ranges::copy(known, memory.begin());
  auto to = memory.begin() + kKnown;
  visit_memory(*this, [&](double number) { *to++ = number; });
}

void InverseController::load_memory(std::span<const double> memory) {
  forget();
  if (memory[0] >= 1.0) {
    time_ = memory[1];
    predicted_error_ = memory[3];
  }
  if (memory[0] >= 2.0) surprise_ = memory[2];
  damping_.set(memory[4]);
  status_ = static_cast<InverseStatus>(static_cast<int>(memory[5]));
  auto from = memory.begin() + kKnown;
  visit_memory(*this, [&](double& number) { number = *from++; });
}

// Of the present configuration, which may be a restored one whose rows no step has formed yet.
double InverseController::error(int task) const {
  const Task& asked = settings_.tasks.at(static_cast<std::size_t>(task));
  const auto& effector = simulation_.model().effector(asked.effector);
  const auto& configuration = simulation_.configuration();
  VectorX goal(effector.row_count()), now(effector.row_count());
  effector.target_delta(configuration, asked.target.at(simulation_.time()), goal);
  effector.target_delta(configuration, effector.value(configuration), now);
  for (Eigen::Index k = 0; k < goal.size(); ++k) {
    if (!(asked.weight(k) > 0.0)) goal[k] = now[k];
  }
  return (goal - now).norm();
}

double InverseController::error() const {
  double worst = 0.0;
  for (std::size_t k = 0; k < settings_.tasks.size(); ++k) {
    worst = std::max(worst, error(static_cast<int>(k)));
  }
  return worst;
}

}  // namespace sinew::inverse
