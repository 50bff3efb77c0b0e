#include "sinew/pcc/arm_pose.hpp"

namespace sinew::pcc {

namespace {

std::span<const double> numbers(const VectorX& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

}  // namespace

ArmPose::ArmPose(const ArmBodyModel& model, const ArmState& state)
    : model_(model),
      state_(state),
      dynamics_(model.shared_arm()),
      skin_(Points::Zero(model.mesh().nodes.rows(), 3)),
      skin_velocities_(skin_),
      columns_(static_cast<std::size_t>(model.arm().coordinates())) {}

void ArmPose::look() const {
  if (looking_) return;
  dynamics_.set(numbers(state_.q), numbers(state_.rate), numbers(state_.rate));
  looking_ = true;
}

const ArmDynamics<double>& ArmPose::dynamics() const {
  look();
  return dynamics_;
}

Vector3 ArmPose::position(int point) const {
  const auto& attachment = model_.attachment(point);
  if (attachment.coordinate >= 0) return {state_.q[attachment.coordinate], 0.0, 0.0};
  return plain(dynamics().position(attachment.point));
}

Vector3 ArmPose::velocity(int point) const {
  const auto& attachment = model_.attachment(point);
  if (attachment.coordinate >= 0) return {state_.rate[attachment.coordinate], 0.0, 0.0};
  look();
  return plain(dynamics_.velocity(attachment.point));
}

const std::vector<Vec3<double>>& ArmPose::jacobian(const ArmPoint& point) {
  dynamics().jacobian(point, columns_);
  return columns_;
}

void ArmPose::show() const {
  if (showing_) return;
  look();
  for (Eigen::Index i = 0; i < skin_.rows(); ++i) {
    const ArmPoint& point = model_.skin_points()[static_cast<std::size_t>(i)];
    skin_.row(i) = plain(dynamics_.position(point)).transpose();
    skin_velocities_.row(i) = plain(dynamics_.velocity(point)).transpose();
  }
  showing_ = true;
}

const Points& ArmPose::skin() const {
  show();
  return skin_;
}

const Points& ArmPose::skin_velocities() const {
  show();
  return skin_velocities_;
}

std::size_t ArmPose::bytes() const {
  return 2 * sizeof(double) * static_cast<std::size_t>(skin_.size());
}

}  // namespace sinew::pcc
