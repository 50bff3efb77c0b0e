/// @file
/// The body of a constant-curvature arm in a step.
#pragma once

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/mechanics/step_system.hpp"
#include "sinew/pcc/arm_equations.hpp"
#include "sinew/pcc/arm_pose.hpp"
#include "sinew/pcc/row_stiffness.hpp"

namespace sinew::pcc {

/// r(q, v, a) = H^T lambda over the arm's coordinates, r of ArmEquations.
class ArmStep : public mechanics::StepSystem {
 public:
  /// @param model,state,pose must outlive this.
  ArmStep(const ArmBodyModel& model, ArmState& state, ArmPose& pose);

  void begin_step() override { state_.start = state_.q; }
  void linearise(const mechanics::LinearisationRequest& request) override;
  void add_curvature(const mechanics::RowCurvature& curvature) override;
  void take_rows(const mechanics::RowValues& rows) override;
  void retake_rows(const mechanics::RowValues& rows) override;
  mechanics::Inertia condense() override;
  void add_compliance(std::span<const int> place, MatrixX& compliance,
                      VectorX& free_motion) const override;

  std::size_t size() const override { return static_cast<std::size_t>(motion_.size()); }
  double residual(std::span<const double> effort, std::span<double> imbalance) override;
  double force_scale() const override { return force_scale_; }
  double rounding_floor() const override;
  void lessen(std::span<const double> force) override;

  void solve_motion(std::span<const double> effort) override;
  void solve(std::span<const double> right, std::span<double> result) override;
  void propose_motion(std::span<const double> motion) override;
  void propose_drift(double time_step) override;
  mechanics::MotionReport apply_motion(double scale) override;
  mechanics::StepEnd end_step(const mechanics::StepWeights& weights) override;

  std::size_t bytes() const;

 private:
  void site_jacobian(int site, MatrixX& result);
  void find_imbalance(std::span<const double> effort);
  void make_definite();
  void respond();
  double keep_motion(const mechanics::StepWeights& weights);

  const ArmBodyModel& model_;
  ArmState& state_;
  ArmPose& pose_;
  ArmEquations equations_;
  RowStiffness row_stiffness_;

  VectorX right_, motion_, scratch_, new_rate_, acceleration_;
  VectorX from_;  // q that motion_ starts from
  VectorX lessening_;
  bool lessens_ = false;
  MatrixX matrix_, symmetric_;
  MatrixX first_jacobian_, second_jacobian_, pulled_;  // (3, n), of a curvature's points
  linalg::LuFactor decomposed_;
  linalg::SymmetricPivots pivots_;
  linalg::SymmetricSpectrum spectrum_;
  bool definite_wanted_ = true;
  bool iterating_ = false;                  // further linearisations of this step may follow
  MatrixX rows_, moved_rows_, compliance_;  // (n, own rows): H^T, A^-1 H^T; (own rows, own rows)
  VectorX free_motion_;
  double force_scale_ = 1.0, least_force_ = 1e-12;
};

}  // namespace sinew::pcc
