#include "sinew/pcc/arm_sensitivity.hpp"

namespace sinew::pcc {

ArmSensitivity::ArmSensitivity(Eigen::Index coordinates, Eigen::Index parameters)
    : decomposed_(coordinates) {
  position_ = rate_ = first_ = second_ = motion_ = velocity_ = acceleration_ = right_ =
      MatrixX::Zero(coordinates, parameters);
}

void ArmSensitivity::start(const MatrixX& position, const MatrixX& rate) {
  position_ = position;
  rate_ = rate;
  first_.setZero();
  second_.setZero();
}

void ArmSensitivity::follow(const ArmSimulation& simulation, const MatrixX& by_parameter) {
  const ArmSimulation::LastStep& last = simulation.last_step();
  const mechanics::StepWeights& weights = last.weights;
  // The part without the motion, which is added after the solution.
  const auto known = [&](const mechanics::Combination& c, MatrixX& result) {
    result = c.velocity * rate_ + c.first * first_ + c.second * second_;
  };
  known(weights.velocity, velocity_);
  known(weights.acceleration, acceleration_);
  right_ = -by_parameter;
  right_.noalias() -= last.linear->by_position * position_;
  right_.noalias() -= last.linear->by_rate * velocity_;
  right_.noalias() -= last.linear->by_acceleration * acceleration_;
  decomposed_.compute(last.matrix);
  motion_.resize(right_.rows(), right_.cols());
  decomposed_.solve_columns(right_, motion_);
  position_ += motion_;
  velocity_ += weights.velocity.motion * motion_;
  known(weights.first, acceleration_);
  acceleration_ += weights.first.motion * motion_;
  known(weights.second, right_);
  right_ += weights.second.motion * motion_;
  first_.swap(acceleration_);
  second_.swap(right_);
  rate_.swap(velocity_);
}

}  // namespace sinew::pcc
