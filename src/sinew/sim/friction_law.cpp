#include "sinew/sim/friction_law.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/sim/model.hpp"

namespace sinew::sim {

namespace {

constexpr int kMostRounds = 300;
constexpr int kPlainRounds = 40;      // before the limits follow more slowly
constexpr double kTolerance = 1e-12;  // of the largest tension

LawProblem with_ranges(const LawProblem& problem, std::span<const ActuatorRange> ranges) {
  return {problem.model,      problem.placement, ranges,       problem.compliance,
          problem.delta_free, problem.delta,     problem.time, problem.time_step};
}

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
  if (off <= kTolerance * largest) return true;
  for (std::size_t k = 0; k < grip_.size(); ++k) {
    ActuatorRange& range = ranges_[first + k];
    range.effort_min += share * (next_[k][0] - range.effort_min);
    range.effort_max += share * (next_[k][1] - range.effort_max);
  }
  return false;
}

LawStatus FrictionLaw::solve(const LawProblem& problem, std::span<double> effort) {
  ranges_.assign(problem.actuators.begin(), problem.actuators.end());
  for (std::size_t k = 0; k < grip_.size(); ++k) {
    const GuideModel& guide = model_.guides()[k];
    const double turn = model_.cable(guide.actuator)->turn(problem.placement, guide.via);
    grip_[k] = -std::expm1(-guide.friction * turn);
  }
  before_.assign(effort.begin(), effort.end());  // a law may look back at the last step
  follow(effort, 1.0);
  LawStatus status = LawStatus::solved;
  for (int round = 0; round < kMostRounds; ++round) {
    std::ranges::copy(before_, effort.begin());
    status = law_->solve(with_ranges(problem, ranges_), effort);
    if (status == LawStatus::failed) return status;
    if (follow(effort, round < kPlainRounds ? 1.0 : 0.5)) break;
  }
  return status;
}

double FrictionLaw::violation(const LawProblem& problem, std::span<const double> effort) const {
  return law_->violation(with_ranges(problem, ranges_), effort);
}

}  // namespace sinew::sim
