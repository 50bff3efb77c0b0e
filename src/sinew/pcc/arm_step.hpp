/// @file
/// The step system of a constant-curvature arm.
#pragma once

#include "sinew/mechanics/dense_step.hpp"
#include "sinew/pcc/arm_equations.hpp"
#include "sinew/pcc/arm_pose.hpp"
#include "sinew/pcc/row_stiffness.hpp"

namespace sinew::pcc {

/// Solves r(q, v, a) = H^T lambda for the coordinates of an arm, with the residual r of
/// ArmEquations.
class ArmStep : public mechanics::DenseStep {
 public:
  /// @param model,state,pose must outlive this.
  ArmStep(const ArmBodyModel& model, ArmState& state, ArmPose& pose);

  void begin_step() override { state_.start = state_.q; }
  double rounding_floor() const override;
  double proposed_move() const override;
  mechanics::MotionReport apply_motion(double scale) override;
  void find_acceleration(const mechanics::StepWeights& weights,
                         std::span<double> acceleration) override;
  void apply_mass(std::span<const double> motion, std::span<double> result) override;
  mechanics::StepEnd end_step(const mechanics::StepWeights& weights) override;
  void scale_motion(double factor) override;
  void add_velocity(std::span<const double> change) override;
  std::size_t bytes() const override;

 private:
  double form(const mechanics::LinearisationRequest& request, VectorX& right,
              MatrixX& matrix) override;
  void add_row_stiffness(MatrixX& matrix) override;
  void site_jacobian(int site, MatrixX& result) const override;
  double softest() const override;
  void depart() override { from_ = state_.q; }
  void drift(double time_step, VectorX& motion) const override;
  double keep_motion(const mechanics::StepWeights& weights);

  const ArmBodyModel& model_;
  ArmState& state_;
  ArmPose& pose_;
  ArmEquations equations_;
  RowStiffness row_stiffness_;
  VectorX scratch_, kept_, new_rate_, acceleration_;
  VectorX from_;  // q at which the motion starts
  double min_force_ = 1e-12;
};

}  // namespace sinew::pcc
