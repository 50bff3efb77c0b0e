#include "sinew/step/step_solver.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/step/controller.hpp"

namespace sinew::step {

namespace {

constexpr int kMaxRounds = 6;
// Of the largest effort: changes below it end the rounds.
constexpr double kSettled = 1e-6;
// Of a negligible miss: misses that differ by less are the same. More would be felt at a minimum,
// which is flat.
constexpr double kSame = 1e-6;
// Points that are tried between two choices.
constexpr int kSearches = 16;

// (controlled,) N: what the controlled actuators did before.
void efforts_before(const StepProblem& problem, const Response& response,
                    std::vector<double>& efforts) {
  efforts.clear();
  for (const int index : response.controlled()) {
    const int row = problem.actuators[static_cast<std::size_t>(index)].row;
    efforts.push_back(problem.effort_before[static_cast<std::size_t>(row)]);
  }
}

}  // namespace

LawStatus StepSolver::solve(const StepProblem& problem, Controller* controller,
                            std::span<double> effort) {
  return controller == nullptr ? direct_.solve(problem, effort)
                               : steer(problem, *controller, effort);
}

LawStatus StepSolver::steer(const StepProblem& problem, Controller& controller,
                            std::span<double> effort) {
  response_.form(problem, effort);
  const bool alone = response_.holds_for_all() && !response_.has_unknowns();
  if (!alone) {
    if (direct_.solve(problem, effort) == LawStatus::failed) return LawStatus::failed;
    response_.form(problem, effort);
  }
  LawStatus status = LawStatus::solved;
  if (alone) {
    double change = 0.0;
    status = choose(problem, controller, effort, change);
    if (status == LawStatus::failed) return status;
    if (direct_.solve(problem, effort) == LawStatus::failed) return LawStatus::failed;
  } else {
    status = settle(problem, controller, effort);
    if (status == LawStatus::failed) return status;
    if (response_.has_decided()) status = take_over(problem, controller, effort);
    if (status == LawStatus::failed) return status;
  }
  measure_motion(problem, effort);
  controller.accept(problem, response_, motion_, chosen_);
  return status;
}

LawStatus StepSolver::settle(const StepProblem& problem, Controller& controller,
                             std::span<double> effort) {
  LawStatus status = LawStatus::solved;
  for (int round = 0; round < kMaxRounds; ++round) {
    double change = 0.0;
    status = choose(problem, controller, effort, change);
    if (status == LawStatus::failed) return status;
    if (direct_.solve(problem, effort) == LawStatus::failed) return LawStatus::failed;
    response_.form(problem, effort);
    if (response_.same_states() && (!response_.bends() || change <= kSettled)) return status;
  }
  search(problem, controller, effort);
  return status;
}

LawStatus StepSolver::take_over(const StepProblem& problem, Controller& controller,
                                std::span<double> effort) {
  held_ = chosen_;
  measure_motion(problem, effort);
  const double miss = controller.miss(problem, motion_);
  if (miss <= controller.negligible_miss()) return LawStatus::solved;
  double change = 0.0;
  response_.form(problem, effort, true);
  LawStatus status = choose(problem, controller, effort, change);
  if (status == LawStatus::failed) return status;
  if (try_efforts(problem, controller, chosen_, effort).miss <
      miss - controller.negligible_miss()) {
    response_.form(problem, effort);
    return settle(problem, controller, effort);
  }
  // As it was, with the controller's program for it.
  try_efforts(problem, controller, held_, effort);
  response_.form(problem, effort);
  status = choose(problem, controller, effort, change);
  chosen_ = held_;
  try_efforts(problem, controller, chosen_, effort);
  return status;
}

LawStatus StepSolver::choose(const StepProblem& problem, Controller& controller,
                             std::span<double> effort, double& change) {
  chosen_before_.swap(chosen_);
  efforts_before(problem, response_, chosen_);
  const LawStatus status = controller.choose(problem, response_, chosen_);
  if (status == LawStatus::failed) return status;
  double largest = 0.0, moved = 0.0;
  for (std::size_t k = 0; k < chosen_.size(); ++k) {
    const auto index = static_cast<std::size_t>(response_.controlled()[k]);
    double& own = effort[static_cast<std::size_t>(problem.actuators[index].row)];
    largest = std::max(largest, std::abs(chosen_[k]));
    moved = std::max(moved, std::abs(chosen_[k] - own));
    own = chosen_[k];
  }
  change = largest > 0.0 ? moved / largest : 0.0;
  return status;
}

void StepSolver::measure_motion(const StepProblem& problem, std::span<const double> effort) {
  motion_ = problem.delta_free;
  for (std::size_t row = 0; row < effort.size(); ++row) {
    if (effort[row] == 0.0) continue;
    motion_ += effort[row] * problem.compliance.col(static_cast<Eigen::Index>(row));
  }
}

StepSolver::Trial StepSolver::try_efforts(const StepProblem& problem, const Controller& controller,
                                          std::span<const double> own, std::span<double> effort) {
  Trial trial;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto index = static_cast<std::size_t>(response_.controlled()[k]);
    const int row = problem.actuators[index].row;
    effort[static_cast<std::size_t>(row)] = own[k];
    trial.strain += problem.compliance(row, row) * own[k] * own[k];
  }
  if (direct_.solve(problem, effort) == LawStatus::failed) return trial;
  measure_motion(problem, effort);
  trial.miss = controller.miss(problem, motion_);
  return trial;
}

// Between misses that are the same but for rounding (a motor pushes a joint against its stop) the
// lesser effort decides.
bool StepSolver::is_better(const Controller& controller, const Trial& one, const Trial& other) {
  const bool same = std::abs(one.miss - other.miss) <= kSame * controller.negligible_miss();
  return same ? one.strain <= other.strain : one.miss < other.miss;
}

void StepSolver::search(const StepProblem& problem, const Controller& controller,
                        std::span<double> effort) {
  const auto at = [&](double share) {
    trial_.resize(chosen_.size());
    for (std::size_t k = 0; k < trial_.size(); ++k) {
      trial_[k] = std::lerp(chosen_before_[k], chosen_[k], share);
    }
    return try_efforts(problem, controller, trial_, effort);
  };
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double from = 0.0, to = 1.0, left = 1.0 - golden, right = golden;
  Trial at_left = at(left), at_right = at(right);
  for (int k = 0; k < kSearches; ++k) {
    if (is_better(controller, at_left, at_right)) {
      to = right;
      right = left;
      at_right = at_left;
      left = from + (1.0 - golden) * (to - from);
      at_left = at(left);
    } else {
      from = left;
      left = right;
      at_left = at_right;
      right = from + golden * (to - from);
      at_right = at(right);
    }
  }
  const double found = at(is_better(controller, at_left, at_right) ? left : right).miss;
  chosen_.swap(trial_);
  efforts_before(problem, response_, trial_);
  const double before = try_efforts(problem, controller, trial_, effort).miss;
  if (before - found <= controller.negligible_miss()) {
    chosen_.swap(trial_);
  } else {
    try_efforts(problem, controller, chosen_, effort);
  }
}

}  // namespace sinew::step
