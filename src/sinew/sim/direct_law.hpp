/// @file
/// The law of direct simulation: every actuator obeys its command within its limits, exactly.
#pragma once

#include "sinew/qp/quadratic_program.hpp"
#include "sinew/sim/effort_boxes.hpp"

namespace sinew::sim {

/// Each row relates effort and motion by a monotone graph:
/// - motion p commanded: delta = p while effort_min < lambda < effort_max; lambda = effort_min with
///   delta >= p (a slack cable); lambda = effort_max with delta <= p (a stalled drive);
/// - effort T commanded: lambda = T while motion_min < delta < motion_max; at motion_max it holds
///   back, lambda <= T; at motion_min it is held, lambda >= T.
/// With delta = delta_free + W lambda these are the optimality conditions of
///   min 1/2 lambda^T W lambda + (delta_free - p)^T lambda,  lower <= lambda <= upper,
/// for the branch that each effort-commanded row is on; branches are switched until all hold. W is
/// positive definite but for redundant cables, whose shares are made unique by adding 1e-12 of its
/// diagonal.
class DirectLaw : public Law {
 public:
  /// @param ranges of the model, see Model::range_count().
  explicit DirectLaw(int ranges);

  LawStatus solve(const LawProblem& problem, std::span<double> effort) override;
  double violation(const LawProblem& problem, std::span<const double> effort) const override;
  void begin_step() override;

 private:
  void form(const LawProblem& problem);
  bool switch_branches(const LawProblem& problem);

  qp::QuadraticProgram program_;
  qp::QpSolver solver_;
  VectorX scale_, scaled_effort_;
  EffortBoxes boxes_;
};

}  // namespace sinew::sim
