#include "sinew/pcc/arm_pose.hpp"

#include <algorithm>

namespace sinew::pcc {

namespace {

using Kind = ArmBodyModel::Attachment::Kind;

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

void ArmPose::update_dynamics() const {
  if (dynamics_current_) return;
  dynamics_.set(numbers(state_.q), numbers(state_.rate), numbers(state_.rate));
  dynamics_current_ = true;
}

const ArmDynamics<double>& ArmPose::dynamics() const {
  update_dynamics();
  return dynamics_;
}

Vector3 ArmPose::position(int point) const {
  return plain(dynamics().position(model_.attachment(point).point));
}

Matrix3 ArmPose::rotation(int orientation) const {
  const auto& attachment = model_.attachment(orientation);
  return plain(dynamics().rotation(attachment.point)) * attachment.rest_rotation.transpose();
}

Vector3 ArmPose::velocity(int site) const {
  const auto& attachment = model_.attachment(site);
  update_dynamics();
  switch (attachment.kind) {
    case Kind::point:
      return plain(dynamics_.velocity(attachment.point));
    case Kind::orientation:
      return plain(dynamics_.angular_velocity(attachment.point));
    case Kind::coordinate:
      return {state_.rate[attachment.coordinate], 0.0, 0.0};
  }
  return {};
}

const std::vector<Vec3<double>>& ArmPose::jacobian(const ArmBodyModel::Attachment& site) {
  switch (site.kind) {
    case Kind::point:
      dynamics().jacobian(site.point, columns_);
      break;
    case Kind::orientation:
      dynamics().angular_jacobian(site.point, columns_);
      break;
    case Kind::coordinate:
      std::ranges::fill(columns_, Vec3<double>());
      columns_[static_cast<std::size_t>(site.coordinate)].x = 1.0;
      break;
  }
  return columns_;
}

void ArmPose::update_skin() const {
  if (skin_current_) return;
  update_dynamics();
  for (Eigen::Index i = 0; i < skin_.rows(); ++i) {
    const ArmPoint& point = model_.skin_points()[static_cast<std::size_t>(i)];
    skin_.row(i) = plain(dynamics_.position(point)).transpose();
    skin_velocities_.row(i) = plain(dynamics_.velocity(point)).transpose();
  }
  skin_current_ = true;
}

const Points& ArmPose::skin() const {
  update_skin();
  return skin_;
}

const Points& ArmPose::skin_velocities() const {
  update_skin();
  return skin_velocities_;
}

std::size_t ArmPose::bytes() const {
  return 2 * sizeof(double) * static_cast<std::size_t>(skin_.size());
}

}  // namespace sinew::pcc
