/// @file
/// The law of direct simulation where bodies touch surfaces: actuators and contacts together.
#pragma once

#include <vector>

#include "sinew/qp/cone_solver.hpp"
#include "sinew/sim/effort_boxes.hpp"

namespace sinew::sim {

/// Actuators obey their commands within their limits as under DirectLaw, contacts obey Signorini's
/// and Coulomb's laws, all in the same compliance: one problem of boxes and cones, solved exactly
/// (qp::ConeSolver), from the last step's efforts.
///
/// Signorini's law is that of the gap at the end of the step, Coulomb's that of the motion along
/// the surface in the step: with velocities d/h (backward Euler) the scheme of Moreau, Jean (1999),
/// Stewart & Trinkle (1996) without restitution, and in a quasi-static step that of incremental
/// friction.
class ContactLaw : public Law {
 public:
  explicit ContactLaw(const Model& model);

  LawStatus solve(const LawProblem& problem, std::span<double> effort) override;
  double violation(const LawProblem& problem, std::span<const double> effort) const override;
  void begin_step() override;
  /// Of the last solve.
  const qp::ConeResult& result() const { return solver_.result(); }

 private:
  bool switch_branches(const LawProblem& problem, std::span<const double> effort);

  EffortBoxes ranges_;
  std::vector<qp::BoxBlock> boxes_;               // (ranges,)
  std::vector<qp::ConeBlock> all_cones_, cones_;  // of all points, and of those in the step
  qp::ConeSolver solver_;
};

}  // namespace sinew::sim
