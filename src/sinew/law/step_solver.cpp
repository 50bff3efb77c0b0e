#include "sinew/law/step_solver.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "sinew/law/certificate.hpp"

namespace sinew::law {

namespace {

constexpr int kMaxRounds = 6;
// Relative to the largest effort: smaller changes end the rounds.
constexpr double kSettled = 1e-6;
// Relative to a limit's size: tolerance of limits.
constexpr double kWithin = 1e-9;
// Relative to the objective: rounding.
constexpr double kOfValue = 1e-10;
// Maximum number of points on the way to an optimum between states, and of halvings of a step along
// a curved piece.
constexpr int kMaxPlaces = 40, kMaxHalvings = 6;

// Efforts of the controlled actuators before the step, (controlled,) N.
void efforts_before(const StepProblem& problem, const Response& response,
                    std::vector<double>& efforts) {
  efforts.clear();
  for (const int index : response.controlled()) {
    const int row = problem.actuators[static_cast<std::size_t>(index)].row;
    efforts.push_back(problem.effort_before[static_cast<std::size_t>(row)]);
  }
}

// Efforts of the controlled actuators in `effort`, (rows,) N, as (controlled,) N.
void own_efforts(const StepProblem& problem, const Response& response,
                 std::span<const double> effort, std::vector<double>& own) {
  own.clear();
  for (const int index : response.controlled()) {
    const int row = problem.actuators[static_cast<std::size_t>(index)].row;
    own.push_back(effort[static_cast<std::size_t>(row)]);
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
  bool alone = problem.contacts.empty();
  if (alone) {
    response_.form(problem, effort);
    alone = response_.holds_for_all() && !response_.has_unknowns();
  }
  if (!alone) {
    if (direct_.solve(problem, effort) == LawStatus::failed) return LawStatus::failed;
    response_.form(problem, effort);
  }
  controller.begin_choices(problem, response_);
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
  controller.accept(problem, response_, motion_, chosen_, effort);
  if (controller.certifies()) {
    controller.take_certificate(certify(problem, controller, effort, cone_settings_));
  }
  return status;
}

// Starts from a solution, usually that at the last step's efforts.
LawStatus StepSolver::settle(const StepProblem& problem, Controller& controller,
                             std::span<double> effort) {
  own_efforts(problem, response_, effort, chosen_);
  measure_motion(problem, effort);
  keep_place(controller.merit(problem, motion_, chosen_, effort), effort);
  LawStatus status = LawStatus::solved;
  for (int round = 0; round < kMaxRounds; ++round) {
    double change = 0.0;
    status = choose(problem, controller, effort, change);
    if (status == LawStatus::failed) return status;
    // The direct solver may fail for a choice that is far off.
    if (direct_.solve(problem, effort) == LawStatus::failed) break;
    response_.form(problem, effort);
    const bool settled = response_.same_states() && (!response_.bends() || change <= kSettled);
    if (!settled && round + 1 < kMaxRounds) continue;
    measure_motion(problem, effort);
    const Merit reached = controller.merit(problem, motion_, chosen_, effort);
    if (settled && !is_better(controller, merit_, reached)) return status;
    if (is_better(controller, reached, merit_)) keep_place(reached, effort);
    if (settled) break;
  }
  const LawStatus descended = descend(problem, controller, effort);
  return descended == LawStatus::failed ? descended : status;
}

void StepSolver::keep_place(const Merit& merit, std::span<const double> effort) {
  merit_ = merit;
  place_.assign(effort.begin(), effort.end());
}

LawStatus StepSolver::descend(const StepProblem& problem, Controller& controller,
                              std::span<double> effort) {
  std::ranges::copy(place_, effort.begin());
  response_.form(problem, effort);
  for (int place = 0; place < kMaxPlaces; ++place) {
    if (!advance(problem, controller, response_, effort) &&
        !cross_guards(problem, controller, effort)) {
      break;
    }
    response_.form(problem, effort);
  }
  own_efforts(problem, response_, effort, chosen_);
  return LawStatus::solved;
}

// Moves towards the optimum of a piece, from place_. If that brings no improvement, restores
// `effort` to place_.
bool StepSolver::advance(const StepProblem& problem, Controller& controller,
                         const Response& response, std::span<double> effort) {
  efforts_before(problem, response, trial_);
  if (controller.choose(problem, response, Guards::kept, trial_) == LawStatus::failed) return false;
  const Merit foreseen{0.0, controller.foreseen()};
  if (merit_.excess <= kWithin && !is_better(controller, foreseen, merit_)) return false;
  double share = 1.0;
  for (int halving = 0; halving <= kMaxHalvings; ++halving, share *= 0.5) {
    middle_.resize(trial_.size());
    for (std::size_t k = 0; k < trial_.size(); ++k) {
      const auto index = static_cast<std::size_t>(response.controlled()[k]);
      const int row = problem.actuators[index].row;
      middle_[k] = std::lerp(place_[static_cast<std::size_t>(row)], trial_[k], share);
    }
    const Merit reached = try_efforts(problem, controller, middle_, effort);
    if (is_better(controller, reached, merit_)) {
      keep_place(reached, effort);
      return true;
    }
    std::ranges::copy(place_, effort.begin());
    if (!response.bends()) break;
  }
  return false;
}

// If guards constrain the choice, moves into the piece beyond one of them, or beyond all.
bool StepSolver::cross_guards(const StepProblem& problem, Controller& controller,
                              std::span<double> effort) {
  efforts_before(problem, response_, trial_);
  if (controller.choose(problem, response_, Guards::kept, trial_) == LawStatus::failed)
    return false;
  pushing_.clear();
  const std::span<const double> multipliers = controller.guard_multipliers();
  for (std::size_t g = 0; g < multipliers.size(); ++g) {
    if (multipliers[g] > 0.0) pushing_.push_back({multipliers[g], static_cast<int>(g)});
  }
  std::ranges::stable_sort(pushing_, std::ranges::greater{}, &Push::multiplier);
  const auto cross = [&](std::span<const Push> guards) {
    const auto now = response_.states();
    states_.assign(now.begin(), now.end());
    for (const Push& push : guards) {
      const Guard& guard = response_.guards()[static_cast<std::size_t>(push.guard)];
      states_[static_cast<std::size_t>(guard.block)] = guard.beyond;
    }
    beyond_.form_as(problem, place_, states_);
    return advance(problem, controller, beyond_, effort);
  };
  for (const Push& push : pushing_) {
    if (cross({&push, 1})) return true;
  }
  return pushing_.size() > 1 && cross(pushing_);
}

LawStatus StepSolver::take_over(const StepProblem& problem, Controller& controller,
                                std::span<double> effort) {
  held_ = chosen_;
  measure_motion(problem, effort);
  const Merit held = controller.merit(problem, motion_, held_, effort);
  double change = 0.0;
  response_.form(problem, effort, true);
  LawStatus status = choose(problem, controller, effort, change);
  if (status == LawStatus::failed) return status;
  if (is_better(controller, try_efforts(problem, controller, chosen_, effort), held)) {
    response_.form(problem, effort);
    return settle(problem, controller, effort);
  }
  // Restores the previous efforts, with the controller's program for them.
  try_efforts(problem, controller, held_, effort);
  response_.form(problem, effort);
  status = choose(problem, controller, effort, change);
  chosen_ = held_;
  try_efforts(problem, controller, chosen_, effort);
  return status;
}

LawStatus StepSolver::choose(const StepProblem& problem, Controller& controller,
                             std::span<double> effort, double& change) {
  efforts_before(problem, response_, chosen_);
  const LawStatus status = controller.choose(problem, response_, Guards::none, chosen_);
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

StepSolver::Merit StepSolver::try_efforts(const StepProblem& problem, const Controller& controller,
                                          std::span<const double> own, std::span<double> effort) {
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto index = static_cast<std::size_t>(response_.controlled()[k]);
    effort[static_cast<std::size_t>(problem.actuators[index].row)] = own[k];
  }
  if (direct_.solve(problem, effort) == LawStatus::failed) return {kInfinity, kInfinity};
  measure_motion(problem, effort);
  return controller.merit(problem, motion_, own, effort);
}

bool StepSolver::is_better(const Controller& controller, const Merit& one, const Merit& other) {
  if (one.excess < other.excess - kWithin) return true;
  if (one.excess > other.excess + kWithin) return false;
  return one.value < other.value - controller.negligible_gain() - kOfValue * std::abs(other.value);
}

}  // namespace sinew::law
