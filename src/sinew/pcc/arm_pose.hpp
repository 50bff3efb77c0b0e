/// @file
/// Positions and velocities of an arm's material.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/pcc/arm_dynamics.hpp"
#include "sinew/pcc/arm_state.hpp"

namespace sinew::pcc {

/// Evaluates the kinematics of an arm on demand, once per state.
class ArmPose {
 public:
  /// @param model,state must outlive this.
  ArmPose(const ArmBodyModel& model, const ArmState& state);

  /// Invalidates the results, since the state has changed.
  void moved() { dynamics_current_ = skin_current_ = false; }

  /// The dynamics, set to the positions and rates of the state.
  const ArmDynamics<double>& dynamics() const;
  Vector3 position(int point) const;        ///< (3,) m, of an attached point
  Matrix3 rotation(int orientation) const;  ///< from rest, of an attached orientation
  Vector3 velocity(int site) const;         ///< see mechanics::Body
  /// Jacobian of a site: a column for each coordinate. Valid until the next call.
  const std::vector<Vec3<double>>& jacobian(const ArmBodyModel::Attachment& site);
  const Points& skin() const;             ///< (n, 3) m, of the nodes of the model's mesh
  const Points& skin_velocities() const;  ///< (n, 3) m/s

  std::size_t bytes() const;

 private:
  void update_dynamics() const;
  void update_skin() const;

  const ArmBodyModel& model_;
  const ArmState& state_;
  mutable ArmDynamics<double> dynamics_;
  mutable bool dynamics_current_ = false;  // dynamics_ matches the state
  mutable Points skin_, skin_velocities_;
  mutable bool skin_current_ = false;  // skin_ and skin_velocities_ match the state
  std::vector<Vec3<double>> columns_;
};

}  // namespace sinew::pcc
