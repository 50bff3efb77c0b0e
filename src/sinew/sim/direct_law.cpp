#include "sinew/sim/direct_law.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::sim {

namespace {

// Relative size of the term that shares tension among redundant cables.
constexpr double kRedundancy = 1e-12;
// Motions that agree within this (m) agree.
constexpr double kMotionTolerance = 1e-12;

// lambda in [lower, upper] and the delta that holds in between.
struct Box {
  double lower, upper, motion;
};

Box box_of(const ActuatorRange& range, bool hold) {
  if (range.kind == CommandKind::motion) {
    return {range.effort_min, range.effort_max, range.value};
  }
  if (hold) return {range.value, range.effort_max, range.motion_min};
  // Without a stroke limit nothing but T itself is possible.
  const double lower = std::isinf(range.motion_max) ? range.value : range.effort_min;
  return {lower, range.value, std::isinf(range.motion_max) ? 0.0 : range.motion_max};
}

}  // namespace

DirectLaw::DirectLaw(int ranges)
    : program_(qp::QuadraticProgram::sized(ranges, 0)),
      solver_(ranges, 0),
      scale_(VectorX::Ones(ranges)),
      scaled_effort_(VectorX::Zero(ranges)),
      branch_(static_cast<std::size_t>(ranges), Branch::pull) {}

void DirectLaw::reset() {
  solver_.reset();
  std::ranges::fill(branch_, Branch::pull);
}

void DirectLaw::form(const LawProblem& problem) {
  const auto& ranges = problem.actuators;
  const auto count = static_cast<Eigen::Index>(ranges.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const ActuatorRange& range = ranges[static_cast<std::size_t>(i)];
    const double diagonal = problem.compliance(range.row, range.row);
    scale_[i] = diagonal > 0.0 ? 1.0 / std::sqrt(diagonal) : 1.0;
  }
  for (Eigen::Index j = 0; j < count; ++j) {
    const int column = ranges[static_cast<std::size_t>(j)].row;
    for (Eigen::Index i = 0; i < count; ++i) {
      const int row = ranges[static_cast<std::size_t>(i)].row;
      program_.hessian(i, j) = scale_[i] * scale_[j] * problem.compliance(row, column);
    }
    program_.hessian(j, j) += kRedundancy;
    const ActuatorRange& range = ranges[static_cast<std::size_t>(j)];
    const Box box = box_of(range, branch_[static_cast<std::size_t>(j)] == Branch::hold);
    program_.gradient[j] = scale_[j] * (problem.delta_free[range.row] - box.motion);
    program_.lower[j] = box.lower / scale_[j];
    program_.upper[j] = std::max(box.lower, box.upper) / scale_[j];
  }
}

// An effort row at T whose motion passed the far stroke limit changes branch.
bool DirectLaw::switch_branches(const LawProblem& problem) {
  bool switched = false;
  for (std::size_t i = 0; i < branch_.size(); ++i) {
    const ActuatorRange& range = problem.actuators[i];
    if (range.kind != CommandKind::effort) continue;
    double delta = problem.delta_free[range.row];
    for (std::size_t j = 0; j < branch_.size(); ++j) {
      const auto k = static_cast<Eigen::Index>(j);
      delta +=
          problem.compliance(range.row, problem.actuators[j].row) * scale_[k] * scaled_effort_[k];
    }
    const Branch before = branch_[i];
    const double tolerance = kMotionTolerance / range.motion_scale;
    if (before == Branch::pull && delta < range.motion_min - tolerance) {
      branch_[i] = Branch::hold;
    } else if (before == Branch::hold && delta > range.motion_max + tolerance) {
      branch_[i] = Branch::pull;
    }
    switched = switched || branch_[i] != before;
  }
  return switched;
}

LawStatus DirectLaw::solve(const LawProblem& problem, std::span<double> effort) {
  const int most_rounds = 2 * static_cast<int>(branch_.size()) + 2;
  for (int round = 0; round < most_rounds; ++round) {
    form(problem);
    const qp::QpResult& result = solver_.solve(program_);
    if (result.status != qp::QpStatus::optimal) return LawStatus::failed;
    scaled_effort_ = result.x;
    for (std::size_t i = 0; i < branch_.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const bool held = branch_[i] == Branch::hold;
      const Box box = box_of(problem.actuators[i], held);
      // Scaling must not blur a limit: a slack cable's tension is zero, not nearly so.
      double lambda = scale_[k] * scaled_effort_[k];
      if (scaled_effort_[k] <= program_.lower[k]) lambda = box.lower;
      if (scaled_effort_[k] >= program_.upper[k]) lambda = std::max(box.lower, box.upper);
      effort[static_cast<std::size_t>(problem.actuators[i].row)] = lambda;
    }
    if (!switch_branches(problem)) return LawStatus::solved;
  }
  return LawStatus::failed;
}

double DirectLaw::violation(const LawProblem& problem, std::span<const double> effort) const {
  double worst = 0.0;
  for (std::size_t i = 0; i < branch_.size(); ++i) {
    const ActuatorRange& range = problem.actuators[i];
    if (range.drive != nullptr) continue;
    const Box box = box_of(range, branch_[i] == Branch::hold);
    const double lambda = effort[static_cast<std::size_t>(range.row)];
    const double gap = problem.delta[range.row] - box.motion;
    const bool at_lower = lambda <= box.lower;
    const bool at_upper = lambda >= box.upper;
    double miss = std::abs(gap);
    if (at_lower) miss = std::max(0.0, -gap);
    if (at_upper) miss = std::max(0.0, gap);
    if (at_lower && at_upper) miss = 0.0;
    worst = std::max(worst, range.motion_scale * miss);
  }
  return worst;
}

}  // namespace sinew::sim
