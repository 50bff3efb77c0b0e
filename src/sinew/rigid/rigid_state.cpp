#include "sinew/rigid/rigid_state.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/core/rotation.hpp"
#include "sinew/rigid/rigid_body_model.hpp"

namespace sinew::rigid {

RigidPose RigidPose::moved(const Vector3& displacement, const Vector3& turn) const {
  const double angle = turn.norm();
  RigidPose result{centre + displacement, rotation};
  if (angle == 0.0) return result;
  result.rotation = Eigen::AngleAxisd(angle, turn / angle) * rotation;
  result.rotation.normalize();
  return result;
}

RigidState::RigidState(const RigidBodyModel& owner, int histories)
    : load_factors(owner.load_count(), 1.0),
      model(owner),
      history(static_cast<std::size_t>(histories), Vector6::Zero()),
      memory(owner.own_rows()) {
  restart();
}

void RigidState::restart() {
  pose = start = {model.centre(), Eigen::Quaterniond::Identity()};
  rate << model.settings().velocity, model.turning_radius() * model.settings().spin;
  for (Vector6& kept : history) kept.setZero();
  asked.reset();
  memory.restart();
}

void RigidState::follow_base() {
  if (!asked) return;
  const Matrix3 turn = Matrix3::Identity() + asked->leftCols<3>();
  pose.centre = model.centre() + mechanics::value_at(*asked, model.centre());
  pose.rotation = Eigen::Quaterniond(turn).normalized();
}

std::size_t RigidState::size() const { return 3 + 4 + 6 * (1 + history.size()) + memory.size(); }

void RigidState::save(std::span<double> to) const {
  double* next = std::copy_n(pose.centre.data(), 3, to.data());
  next = std::copy_n(pose.rotation.coeffs().data(), 4, next);
  next = std::copy_n(rate.data(), 6, next);
  for (const Vector6& kept : history) next = std::copy_n(kept.data(), 6, next);
  memory.save(next);
}

void RigidState::load(std::span<const double> from) {
  const double* next = from.data();
  const auto take = [&](double* to, int count) {
    std::copy_n(next, count, to);
    next += count;
  };
  take(pose.centre.data(), 3);
  take(pose.rotation.coeffs().data(), 4);
  // An estimator adds to it, so it is normalised; a saved one keeps its bits.
  if (std::abs(pose.rotation.squaredNorm() - 1.0) > 1e-12) pose.rotation.normalize();
  take(rate.data(), 6);
  for (Vector6& kept : history) take(kept.data(), 6);
  memory.load(next);
}

Vector6 RigidState::motion() const {
  const Eigen::Quaterniond turn = pose.rotation * start.rotation.conjugate();
  Vector6 result;
  result << pose.centre - start.centre,
      model.turning_radius() * rotation_vector(turn.toRotationMatrix());
  return result;
}

Vector6 RigidState::combine(const mechanics::Combination& weights) const {
  Vector6 result = weights.motion * motion() + weights.velocity * rate;
  if (history.empty()) return result;
  return result + weights.first * history[0] + weights.second * history[1];
}

}  // namespace sinew::rigid
