#include "sinew/rigid/rigid_nodes.hpp"

#include "sinew/rigid/rigid_body_model.hpp"

namespace sinew::rigid {

void place_nodes(const RigidBodyModel& model, const Points& rest, const RigidPose& pose,
                 Points& nodes) {
  const Matrix3 turn = pose.rotation.toRotationMatrix();
  nodes.resize(rest.rows(), 3);
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const Vector3 arm = rest.row(i).transpose() - model.centre();
    nodes.row(i) = (pose.centre + turn * arm).transpose();
  }
}

const Points& RigidNodes::positions() {
  const RigidPose& pose = state_.pose;
  const bool same =
      pose_ && pose_->centre == pose.centre && pose_->rotation.coeffs() == pose.rotation.coeffs();
  if (!same) {
    place_nodes(state_.model, rest_, pose, positions_);
    pose_ = pose;
  }
  return positions_;
}

const Points& RigidNodes::velocities() {
  const Vector3 linear = state_.rate.head<3>();
  const Vector3 spin = state_.rate.tail<3>() / state_.model.turning_radius();
  const Points& at = positions();
  velocities_.resize(at.rows(), 3);
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    const Vector3 arm = at.row(i).transpose() - state_.pose.centre;
    velocities_.row(i) = (linear + spin.cross(arm)).transpose();
  }
  return velocities_;
}

}  // namespace sinew::rigid
