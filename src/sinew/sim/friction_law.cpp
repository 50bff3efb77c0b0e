#include "sinew/sim/friction_law.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/constraint/cable.hpp"
#include "sinew/sim/model.hpp"

namespace sinew::sim {

namespace {

constexpr int kMostFrictionRounds = 300;
constexpr int kPlainRounds = 40;              // before the limits follow more slowly
constexpr double kFrictionTolerance = 1e-12;  // of the largest tension
constexpr int kControlRounds = 8;
constexpr double kControlTolerance = 1e-6;

}  // namespace

ActuatorRange guide_range(const GuideModel& guide, const VectorX& delta) {
  ActuatorRange range;
  range.row = guide.row;
  range.motion_min = -INFINITY;
  range.motion_max = INFINITY;
  range.kind = CommandKind::motion;
  range.value = delta[guide.row];
  return range;
}

FrictionLaw::FrictionLaw(const Model& model)
    : model_(model), grip_(model.guides().size()), next_(model.guides().size()) {
  ranges_.reserve(model.range_count());
}

// Whether the limits are those of the tensions; if not, they go `share` of the way there.
bool FrictionLaw::follow(std::span<const double> effort, double share) {
  double off = 0.0, largest = 0.0, tension = 0.0;
  const std::size_t first = model_.actuators().size();
  for (std::size_t k = 0; k < grip_.size(); ++k) {
    const GuideModel& guide = model_.guides()[k];
    if (guide.via == 0) tension = effort[static_cast<std::size_t>(guide.row - 1)];
    const double behind = tension - effort[static_cast<std::size_t>(guide.row)];
    const ActuatorRange& range = ranges_[first + k];
    const double most = grip_[k] * std::max(tension, 0.0);
    const double least = -grip_[k] * std::max(behind, 0.0);
    largest = std::max({largest, std::abs(tension), std::abs(behind)});
    off = std::max({off, std::abs(most - range.effort_max), std::abs(least - range.effort_min)});
    next_[k] = {least, most};
    tension = behind;
  }
  if (off <= kFrictionTolerance * largest) return true;
  for (std::size_t k = 0; k < grip_.size(); ++k) {
    ActuatorRange& range = ranges_[first + k];
    range.effort_min += share * (next_[k][0] - range.effort_min);
    range.effort_max += share * (next_[k][1] - range.effort_max);
  }
  return false;
}

// Friction of the tensions in `ranges_`, and those tensions where they are not given.
LawStatus FrictionLaw::slide(const LawProblem& problem, std::span<double> effort) {
  follow(effort, 1.0);
  for (int round = 0; round < kMostFrictionRounds; ++round) {
    if (direct_->solve(problem.with_ranges(ranges_), effort) == LawStatus::failed) {
      return LawStatus::failed;
    }
    if (follow(effort, round < kPlainRounds ? 1.0 : 0.5)) break;
  }
  return LawStatus::solved;
}

LawStatus FrictionLaw::solve(const LawProblem& problem, std::span<double> effort) {
  ranges_.assign(problem.actuators.begin(), problem.actuators.end());
  for (std::size_t k = 0; k < grip_.size(); ++k) {
    const GuideModel& guide = model_.guides()[k];
    const double turn = model_.cable(guide.actuator)->turn(problem.placement, guide.via);
    grip_[k] = -std::expm1(-guide.friction * turn);
  }
  return controller_ == nullptr ? slide(problem, effort) : control(problem, effort);
}

LawStatus FrictionLaw::control(const LawProblem& problem, std::span<double> effort) {
  const auto own = problem.actuators.first(model_.actuators().size());
  before_.assign(effort.begin(), effort.end());
  chosen_.resize(effort.size());
  LawStatus status = LawStatus::solved;
  for (int round = 0; round < kControlRounds; ++round) {
    delta_free_ = problem.delta_free;
    for (const GuideModel& guide : model_.guides()) {
      delta_free_ +=
          effort[static_cast<std::size_t>(guide.row)] * problem.compliance.col(guide.row);
    }
    const LawProblem rest = problem.reduced(own, problem.compliance, delta_free_);
    std::ranges::copy(before_, chosen_.begin());  // a law may look back at the last step
    for (const GuideModel& guide : model_.guides()) {
      chosen_[static_cast<std::size_t>(guide.row)] = 0.0;
    }
    status = controller_->solve(rest, chosen_);
    if (status == LawStatus::failed) return status;
    double change = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      const auto row = static_cast<std::size_t>(own[i].row);
      ActuatorRange& range = ranges_[i];
      change = std::max(change, std::abs(chosen_[row] - effort[row]));
      largest = std::max(largest, std::abs(chosen_[row]));
      effort[row] = chosen_[row];
      range.kind = CommandKind::effort;
      range.value = range.effort_min = range.effort_max = chosen_[row];
      range.motion_min = -INFINITY;
      range.motion_max = INFINITY;
      range.drive = nullptr;
    }
    if (slide(problem, effort) == LawStatus::failed) return LawStatus::failed;
    if (change <= kControlTolerance * largest) break;
  }
  return status;
}

double FrictionLaw::violation(const LawProblem& problem, std::span<const double> effort) const {
  const double own = direct_->violation(problem.with_ranges(ranges_), effort);
  return controller_ == nullptr ? own : std::max(own, controller_->violation(problem, effort));
}

}  // namespace sinew::sim
