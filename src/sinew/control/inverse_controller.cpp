#include "sinew/control/inverse_controller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/core/error.hpp"
#include "sinew/law/response.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::control {

namespace {

using law::ActuatorBlock;
using law::LawStatus;
using law::Response;
using law::StepProblem;

// A limit is active if the solution is this near, relative to its size.
constexpr double kActive = 1e-9;
// At rest nothing moves by more than this part of the tolerance in a step, so that a slow approach
// to an optimum covers less than a hundredth of the tolerance in fifty steps.
constexpr double kStill = 2e-4;
// At rest, forces balance to this part of their size.
constexpr double kBalanced = 1e-3;
// A robot that rests only because its steps are damped this much is held back.
constexpr double kDistrusted = 256.0;
// Relative tolerance of a requested contact force.
constexpr double kForceTolerance = 1e-2;

bool near(double value, double limit) {
  return std::isfinite(limit) && std::abs(value - limit) <= kActive * (1.0 + std::abs(limit));
}

// Its own settings are checked before those of all controllers.
TargetSettings checked(const model::Model& model, TargetSettings settings,
                       const InverseSettings& own) {
  check_settings(model, settings, own);
  return settings;
}

}  // namespace

InverseController::InverseController(sim::Simulation& simulation, TargetSettings settings,
                                     InverseSettings own)
    : TargetController(simulation, checked(simulation.model(), std::move(settings), own)),
      own_(std::move(own)) {
  const model::Model& model = simulation_.model();
  std::vector<double> weights;
  for (const EffectorTask& task : settings_.tasks) {
    const auto& effector = model.effector(task.effector);
    const bool turns = effector.kind() == constraint::EffectorKind::orientation;
    for (int k = 0; k < effector.row_count(); ++k) {
      effector_rows_.push_back(effector.first_row() + k);
      row_turns_.push_back(turns);
      weights.push_back(task.weight_by_priority(k));
    }
  }
  const auto rows = static_cast<Eigen::Index>(effector_rows_.size());
  const auto count = static_cast<Eigen::Index>(settings_.actuators.size());
  row_weights_ = Eigen::Map<VectorX>(weights.data(), rows);
  residual_.setZero(rows);
  gap_.setZero(rows);
  gap_before_.setZero(rows);
  for_later_.setZero(rows);
  foreseen_.setZero(rows);
  asked_.assign(settings_.tasks.size(), Vector3::Zero());
  const double largest = rows > 0 ? row_weights_.maxCoeff() : 0.0;
  program_ = EffortProgram(effector_rows_, row_weights_, static_cast<int>(count),
                           ForceRows(own_.contacts, largest > 0.0 ? largest : 1.0));
  force_errors_.assign(own_.contacts.size(), std::numeric_limits<double>::quiet_NaN());
  efforts_.setZero(count);
  last_choice_.setZero(count);
  gap_linearised_.setZero(rows);
  change_.setZero(count);
  expected_.setZero(rows);
  std::vector<int> contacts;
  for (const ContactTask& task : own_.contacts) contacts.push_back(task.contact);
  simulation_.attach(*this, settings_.actuators, contacts);
  attached_ = true;
}

InverseController::~InverseController() { InverseController::detach(); }

void InverseController::detach() {
  if (attached_) simulation_.detach(*this);
  attached_ = false;
}

ControllerStatus InverseController::step() {
  simulation_.step();
  return status_;
}

// The law of a step may be solved several times. On the first call of a step, evaluates the outcome
// of the previous step and sets the targets of this one. On later calls, after the robot has been
// linearised anew, evaluates the outcome of the last choice.
void InverseController::look_back(const StepProblem& problem, const Response& response) {
  if (!(problem.time > time_)) return review_choice(problem, response);
  inner_damping_.set(1.0);
  tried_ = false;
  if (std::isfinite(time_)) {
    measure_gap(problem);
    surprise_ = came_ = 0.0;
    for (Eigen::Index k = 0; k < gap_.size(); ++k) {
      if (!(row_weights_[k] > 0.0)) continue;
      surprise_ = std::hypot(surprise_, gap_[k] - foreseen_[k]);
      came_ = std::hypot(came_, gap_[k] - gap_before_[k]);
    }
    review(damping_, response, gap_before_);
  }
  time_ = problem.time;
  double farthest = 0.0;  // motion of a target
  for (std::size_t t = 0; t < asked_.size(); ++t) {
    const Vector3 target = settings_.tasks[t].target.at(time_);
    farthest = std::max(farthest, (target - asked_[t]).norm());
    asked_[t] = target;
  }
  // A robot that was held back may be free to move elsewhere.
  if (status_ == ControllerStatus::held_back && farthest > kStill * settings_.tolerance) {
    damping_.set(std::min(damping_.value(), kDistrusted));
  }
  for (int k = 0; k < failures_; ++k) damping_.reject();
  measure_gap(problem);
  gap_before_ = gap_;
  gap_linearised_ = gap_;
}

// Within a step the damping only grows, so that alternating choices converge.
void InverseController::review_choice(const StepProblem& problem, const Response& response) {
  if (!tried_) return;
  measure_gap(problem);
  const double least = inner_damping_.value();
  review(inner_damping_, response, gap_linearised_);
  inner_damping_.set(std::max(least, inner_damping_.value()));
  gap_linearised_ = gap_;
  tried_ = false;
}

// A quasi-static step moves effectors as predicted, since it is linear. W_ea shows that they move
// differently from there on: by the trapezoidal rule, the change d of efforts gains
//   1/2 (W_ea d - W_ea' d)^T Q gap
// less than foreseen. It is the second derivatives' part that least squares leave out, as J. E.
// Dennis, D. M. Gay & R. E. Welsch, ACM Trans. Math. Software 7 (1981) 348-368, section 3, find it.
// In a dynamic step, most of the linearisation error is in the motion that the robot makes without
// d. A smaller d would not reduce it, so damping would grow and never decay. Only the predicted
// gain of d and its gain by the trapezoidal rule are therefore compared, both relative to the gap
// without d. If both are negligible, the damping decays.
void InverseController::review(StepDamping& damping, const Response& response,
                               const VectorX& before) const {
  const bool dynamic = simulation_.model().step().dynamic();
  const VectorX& begun = dynamic ? (without_ = foreseen_ + expected_) : before;
  double bend = 0.0;
  for (Eigen::Index k = 0; k < begun.size(); ++k) {
    const int row = effector_rows_[static_cast<std::size_t>(k)];
    const double leads = response.compliance().row(row).dot(change_);
    bend += 0.5 * row_weights_[k] * (expected_[k] - leads) * begun[k];
  }
  const double foreseen = objective(foreseen_);
  const double found = dynamic ? foreseen + bend : std::max(objective(gap_), foreseen + bend);
  const bool judged = damping.review(objective(begun), foreseen, found, negligible_objective());
  if (dynamic && !judged) damping.relax();
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
  const double weight = row_weights_.size() > 0 ? row_weights_.maxCoeff() : 1.0;
  return 0.5 * weight * still * still;
}

// The goal of a step does not change when the step is linearised again: it is the part of the gap
// at its start that one step may close. An angle counts as its arc at a distance of the robot's
// size.
void InverseController::form_residual(const StepProblem& problem, const Response& response) {
  measure_gap(problem);
  double to_go = 0.0;
  for (Eigen::Index k = 0; k < gap_.size(); ++k) {
    const double arm = row_turns_[static_cast<std::size_t>(k)] ? problem.size : 1.0;
    if (row_weights_[k] > 0.0) to_go = std::hypot(to_go, arm * gap_before_[k]);
  }
  const double most = largest_step(problem);
  for_later_ = (1.0 - (to_go > most ? most / to_go : 1.0)) * gap_before_;
  for (Eigen::Index k = 0; k < residual_.size(); ++k) {
    const int row = effector_rows_[static_cast<std::size_t>(k)];
    residual_[k] = response.free()[row] - problem.delta[row] - (gap_[k] - for_later_[k]);
  }
}

void InverseController::begin_choices(const StepProblem& problem, const Response& response) {
  look_back(problem, response);
  form_residual(problem, response);
  const bool change = own_.regularisation == Regularisation::change;
  program_.begin(problem, response,
                 {.epsilon = own_.epsilon,
                  .to_zero = change ? own_.relaxation : 1.0,
                  .damping = damping_.value(),
                  .damping_within = inner_damping_.value(),
                  .last_choice = last_choice_},
                 largest_step(problem));
}

LawStatus InverseController::choose(const StepProblem& problem, const Response& response,
                                    law::Guards guards, std::span<double> effort) {
  form_residual(problem, response);
  program_.form(problem, response, residual_);
  if (guards == law::Guards::none) {
    return program_.solve(simulation_.model(), problem, response, effort);
  }
  return program_.solve_guarded(problem, response, guards == law::Guards::tight, effort);
}

double InverseController::largest_step(const StepProblem& problem) const {
  return own_.largest_step * problem.size;
}

law::Controller::Merit InverseController::merit(const StepProblem& problem, const VectorX& motion,
                                                std::span<const double> own,
                                                std::span<const double> effort) const {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < gap_.size(); ++k) {
    const int row = effector_rows_[static_cast<std::size_t>(k)];
    const double left = motion[row] - problem.delta[row] - (gap_[k] - for_later_[k]);
    sum += row_weights_[k] * left * left;
  }
  return {program_.excess(problem, motion, own),
          0.5 * sum + program_.pull_value(own) + program_.forces().cost(problem, motion, effort)};
}

void InverseController::accept(const StepProblem& problem, const Response& response,
                               const VectorX& motion, std::span<const double> own,
                               std::span<const double> effort) {
  tried_ = true;
  last_choice_ = Eigen::Map<const VectorX>(own.data(), std::ssize(own));
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto place = std::ranges::find(settings_.actuators, response.controlled()[k]);
    efforts_[place - settings_.actuators.begin()] = own[k];
    const int row = controlled_block(problem, response, static_cast<Eigen::Index>(k)).row;
    change_[static_cast<Eigen::Index>(k)] =
        own[k] - problem.effort_before[static_cast<std::size_t>(row)];
  }
  for (Eigen::Index k = 0; k < expected_.size(); ++k) {
    const int row = effector_rows_[static_cast<std::size_t>(k)];
    expected_[k] = response.compliance().row(row).dot(change_);
  }
  measure_forces(problem, motion, effort);
  const double moved = foresee(problem, response, motion);
  status_ = conflict().empty() ? judge(problem, response, motion, own, moved)
                               : ControllerStatus::limits_conflict;
}

void InverseController::measure_forces(const StepProblem& problem, const VectorX& motion,
                                       std::span<const double> effort) {
  for (std::size_t k = 0; k < force_errors_.size(); ++k) {
    force_errors_[k] = program_.forces().miss(k, problem, motion, effort);
  }
}

bool InverseController::forces_hold() const {
  for (std::size_t k = 0; k < force_errors_.size(); ++k) {
    const ContactTask& task = own_.contacts[k];
    const double asked = task.normal_min > 0.0 ? task.normal_min : task.normal_max;
    if (std::isfinite(asked) && force_errors_[k] > kForceTolerance * asked) return false;
    if (!std::isfinite(asked) && force_errors_[k] > 0.0) return false;
  }
  return true;
}

// Predicts the end of the step from the linearisation: the gaps that remain. Returns the largest
// motion of an effector or actuator in the step, m.
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
  for (Eigen::Index k = 0; k < last_choice_.size(); ++k) {
    const ActuatorBlock& own = controlled_block(problem, response, k);
    const int index = response.controlled()[static_cast<std::size_t>(k)];
    const double change = motion[own.row] - simulation_.actuator(index).motion;
    moved = std::max(moved, own.motion_scale * std::abs(change));
  }
  return moved;
}

ControllerStatus InverseController::judge(const StepProblem& problem, const Response& response,
                                          const VectorX& motion, std::span<const double> effort,
                                          double moved) const {
  if (predicted_error_ <= settings_.tolerance && forces_hold()) {
    return surprise_ <= settings_.tolerance ? ControllerStatus::on_target
                                            : ControllerStatus::moving;
  }
  if (rate_binds(problem, response, motion, effort)) return ControllerStatus::rate_limited;
  const double still = kStill * settings_.tolerance;
  const bool sound =
      surprise_ <= settings_.tolerance && simulation_.report().relative_residual <= kBalanced;
  if (!sound) return ControllerStatus::moving;
  // Without damping, the step would have gone farther by this factor. Where the robot is about to
  // buckle, the linearisation predicts motions that steps cannot make.
  if (moved * damping_.value() > still) {
    const bool held = damping_.value() >= kDistrusted && came_ <= still;
    return held ? ControllerStatus::held_back : ControllerStatus::moving;
  }
  return program_.limit_holds(foreseen_.norm()) ? ControllerStatus::out_of_reach
                                                : ControllerStatus::local_optimum;
}

bool InverseController::rate_binds(const StepProblem& problem, const Response& response,
                                   const VectorX& motion, std::span<const double> effort) const {
  for (Eigen::Index k = 0; k < last_choice_.size(); ++k) {
    const ActuatorBlock& own = controlled_block(problem, response, k);
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

void InverseController::hold_back(int failures) {
  for (int k = 0; k < failures; ++k) damping_.reject();
  status_ = ControllerStatus::held_back;
  for (std::size_t k = 0; k < settings_.actuators.size(); ++k) {
    efforts_[static_cast<Eigen::Index>(k)] = simulation_.actuator(settings_.actuators[k]).effort;
  }
}

void InverseController::begin_step(int failures) {
  program_.reset();
  failures_ = failures;
}

}  // namespace sinew::control
