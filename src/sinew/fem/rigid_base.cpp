#include "sinew/fem/rigid_base.hpp"

#include <algorithm>

namespace sinew::fem {

bool RigidBase::begin_step() {
  start_ = displacement_;
  if (asked_) displacement_ = *asked_;
  return displacement_ != start_;
}

AffineField RigidBase::combine(const mechanics::Combination& weights) const {
  AffineField sum = weights.motion * (displacement_ - start_) + weights.velocity * velocity_;
  if (!history_.empty()) sum += weights.first * history_[0] + weights.second * history_[1];
  return sum;
}

void RigidBase::end_step(const mechanics::StepWeights& weights) {
  moved_ = moves();
  const bool dynamic = weights.dynamic();
  const AffineField none = AffineField::Zero();
  const AffineField velocity = dynamic ? combine(weights.velocity) : none;
  if (!history_.empty()) {
    const AffineField first = dynamic ? combine(weights.first) : none;
    history_[1] = dynamic ? combine(weights.second) : none;
    history_[0] = first;
  }
  velocity_ = velocity;
  start_ = displacement_;
}

void RigidBase::restart() {
  asked_.reset();
  displacement_.setZero();
  start_.setZero();
  velocity_.setZero();
  for (AffineField& kept : history_) kept.setZero();
  moved_ = false;
}

bool RigidBase::moves() const {
  const auto kept = [](const AffineField& field) { return !field.isZero(0.0); };
  return displacement_ != start_ || kept(velocity_) || std::ranges::any_of(history_, kept);
}

Vector3 RigidBase::turn_back(const Vector3& start) const {
  return start + start_.leftCols<3>().transpose() * start;
}

Vector3 RigidBase::rest_of(const Vector3& start) const { return turn_back(start - start_.col(3)); }

void RigidBase::save_state(std::span<double> state) const {
  double* to = std::copy_n(displacement_.data(), 12, state.data());
  to = std::copy_n(velocity_.data(), 12, to);
  for (const AffineField& kept : history_) to = std::copy_n(kept.data(), 12, to);
}

void RigidBase::load_state(std::span<const double> state) {
  const double* from = state.data();
  const auto take = [&](AffineField& field) {
    std::copy_n(from, 12, field.data());
    from += 12;
  };
  take(displacement_);
  take(velocity_);
  for (AffineField& kept : history_) take(kept);
  start_ = displacement_;
  moved_ = false;
}

}  // namespace sinew::fem
