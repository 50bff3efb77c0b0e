#include "sinew/sim/direct_law.hpp"

#include <cmath>

namespace sinew::sim {

namespace {

// Relative size of the term that shares tension among redundant cables.
constexpr double kRedundancy = 1e-12;

}  // namespace

DirectLaw::DirectLaw(int ranges)
    : program_(qp::QuadraticProgram::sized(ranges, 0)),
      solver_(ranges, 0),
      scale_(VectorX::Ones(ranges)),
      scaled_effort_(VectorX::Zero(ranges)),
      boxes_(ranges) {}

void DirectLaw::begin_step() {
  solver_.reset();
  boxes_.reset();
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
    const EffortBox box = boxes_.box(static_cast<std::size_t>(j), range);
    program_.gradient[j] = scale_[j] * (problem.delta_free[range.row] - box.motion);
    program_.lower[j] = box.lower / scale_[j];
    program_.upper[j] = box.upper / scale_[j];
  }
}

bool DirectLaw::switch_branches(const LawProblem& problem) {
  bool switched = false;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const ActuatorRange& range = problem.actuators[i];
    if (range.kind != CommandKind::effort) continue;
    double delta = problem.delta_free[range.row];
    for (std::size_t j = 0; j < boxes_.size(); ++j) {
      const auto k = static_cast<Eigen::Index>(j);
      delta +=
          problem.compliance(range.row, problem.actuators[j].row) * scale_[k] * scaled_effort_[k];
    }
    switched = boxes_.switch_branch(i, range, delta) || switched;
  }
  return switched;
}

LawStatus DirectLaw::solve(const LawProblem& problem, std::span<double> effort) {
  const int most_rounds = 2 * static_cast<int>(boxes_.size()) + 2;
  for (int round = 0; round < most_rounds; ++round) {
    form(problem);
    const qp::QpResult& result = solver_.solve(program_);
    if (result.status != qp::QpStatus::optimal) return LawStatus::failed;
    scaled_effort_ = result.x;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const EffortBox box = boxes_.box(i, problem.actuators[i]);
      // Scaling must not blur a limit: a slack cable's tension is zero, not nearly so.
      double lambda = scale_[k] * scaled_effort_[k];
      if (scaled_effort_[k] <= program_.lower[k]) lambda = box.lower;
      if (scaled_effort_[k] >= program_.upper[k]) lambda = box.upper;
      effort[static_cast<std::size_t>(problem.actuators[i].row)] = lambda;
    }
    if (!switch_branches(problem)) return LawStatus::solved;
  }
  return LawStatus::failed;
}

double DirectLaw::violation(const LawProblem& problem, std::span<const double> effort) const {
  return boxes_.violation(problem, effort);
}

}  // namespace sinew::sim
