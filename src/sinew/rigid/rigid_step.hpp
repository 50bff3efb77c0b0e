/// @file
/// The step of a rigid body.
#pragma once

#include "sinew/mechanics/dense_step.hpp"
#include "sinew/rigid/rigid_loads.hpp"
#include "sinew/rigid/rigid_state.hpp"

namespace sinew::rigid {

/// The step equations of a rigid body: the Newton-Euler equations at the end of the step, in world
/// axes (Featherstone, Rigid Body Dynamics Algorithms, 2008, sec. 2.15),
///   m a = m g + loads + forces,   J alpha + omega x J omega = moments about the centre,
///   J = R J_0 R^T,
/// where a and alpha are the integrator's combinations. The unknowns are the six numbers of a
/// motion. A rotation by w after the rotation vector theta since the start of the step changes
/// theta by D w (rotation_vector_rate), and J by [w] J - J [w]. The matrix is the exact derivative,
/// unsymmetric.
class RigidStep : public mechanics::DenseStep {
 public:
  /// @param state must outlive this.
  explicit RigidStep(RigidState& state);

  void begin_step() override;
  void begin_query() override;
  void add_proposed_motion(Points& nodes) const override;
  mechanics::Wrench unbalanced(std::span<const double> effort, const Vector3& about) override;
  double rounding_floor() const override;
  double proposed_move() const override;
  mechanics::MotionReport apply_motion(double scale) override;
  void find_acceleration(const mechanics::StepWeights& weights,
                         std::span<double> acceleration) override;
  void apply_mass(std::span<const double> motion, std::span<double> result) override;
  mechanics::StepEnd end_step(const mechanics::StepWeights& weights) override;
  void scale_motion(double factor) override;
  void add_velocity(std::span<const double> change) override;
  /// See RigidLoads::resultant().
  const mechanics::Wrench& loads() const { return loads_.resultant(); }
  std::size_t bytes() const override { return DenseStep::bytes() + loads_.bytes(); }

 private:
  double form(const mechanics::LinearisationRequest& request, VectorX& right,
              MatrixX& matrix) override;
  void add_row_stiffness(MatrixX& matrix) override;
  void site_jacobian(int site, MatrixX& result) const override;
  void patch_jacobian(const mechanics::Patch& patch, MatrixX& result) const override;
  double softest() const override { return 0.0; }
  void depart() override { from_ = state_.pose; }
  void drift(double time_step, VectorX& motion) const override { motion = time_step * state_.rate; }
  Vector3 arm_of(const mechanics::Patch& patch) const;
  void add_inertia(const mechanics::StepWeights& weights, VectorX& right, MatrixX& matrix) const;

  RigidState& state_;
  RigidLoads loads_;
  RigidPose from_;  // the pose from which the motion starts
};

}  // namespace sinew::rigid
