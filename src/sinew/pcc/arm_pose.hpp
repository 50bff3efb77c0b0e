/// @file
/// Where the material of an arm's body is, and how it moves.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/pcc/arm_dynamics.hpp"
#include "sinew/pcc/arm_state.hpp"

namespace sinew::pcc {

/// Evaluates the arm's kinematics at the state when somebody asks, once for each state.
class ArmPose {
 public:
  /// @param model,state must outlive this.
  ArmPose(const ArmBodyModel& model, const ArmState& state);

  /// The state is another from now on.
  void moved() { dynamics_current_ = skin_current_ = false; }

  /// At the state; see ArmDynamics::set().
  const ArmDynamics<double>& dynamics() const;
  Vector3 position(int point) const;        ///< (3,) m, of an attached point
  Matrix3 rotation(int orientation) const;  ///< since rest, of an attached orientation
  Vector3 velocity(int site) const;         ///< see mechanics::Body
  /// (3,) columns for the coordinates: a site's motion; valid until the next call.
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
  mutable bool dynamics_current_ = false;  // dynamics_ is at the state
  mutable Points skin_, skin_velocities_;
  mutable bool skin_current_ = false;  // so are these
  std::vector<Vec3<double>> columns_;
};

}  // namespace sinew::pcc
