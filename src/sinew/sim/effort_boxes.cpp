#include "sinew/sim/effort_boxes.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::sim {

namespace {

// Motions that agree within this (m) agree.
constexpr double kMotionTolerance = 1e-12;

}  // namespace

EffortBoxes::EffortBoxes(int ranges) : branch_(static_cast<std::size_t>(ranges), Branch::pull) {}

void EffortBoxes::reset() { std::ranges::fill(branch_, Branch::pull); }

EffortBox EffortBoxes::box(std::size_t range, const ActuatorRange& what) const {
  if (what.kind == CommandKind::motion) {
    return {what.effort_min, std::max(what.effort_min, what.effort_max), what.value};
  }
  if (branch_[range] == Branch::hold) {
    return {what.value, std::max(what.value, what.effort_max), what.motion_min};
  }
  // Without a stroke limit nothing but T itself is possible.
  const bool held = !std::isinf(what.motion_max);
  const double lower = held ? what.effort_min : what.value;
  return {lower, std::max(lower, what.value), held ? what.motion_max : 0.0};
}

// An effort row at T whose motion passed the far stroke limit changes branch.
bool EffortBoxes::switch_branch(std::size_t range, const ActuatorRange& what, double motion) {
  if (what.kind != CommandKind::effort) return false;
  const Branch before = branch_[range];
  const double tolerance = kMotionTolerance / what.motion_scale;
  if (before == Branch::pull && motion < what.motion_min - tolerance) {
    branch_[range] = Branch::hold;
  } else if (before == Branch::hold && motion > what.motion_max + tolerance) {
    branch_[range] = Branch::pull;
  }
  return branch_[range] != before;
}

double EffortBoxes::violation(const LawProblem& problem, std::span<const double> effort) const {
  double worst = 0.0;
  for (std::size_t i = 0; i < branch_.size(); ++i) {
    const ActuatorRange& range = problem.actuators[i];
    if (range.drive != nullptr) continue;
    const EffortBox own = box(i, range);
    const double lambda = effort[static_cast<std::size_t>(range.row)];
    const double gap = problem.delta[range.row] - own.motion;
    const bool at_lower = lambda <= own.lower;
    const bool at_upper = lambda >= own.upper;
    double miss = std::abs(gap);
    if (at_lower) miss = std::max(0.0, -gap);
    if (at_upper) miss = std::max(0.0, gap);
    if (at_lower && at_upper) miss = 0.0;
    worst = std::max(worst, range.motion_scale * miss);
  }
  return worst;
}

}  // namespace sinew::sim
