#include "sinew/pcc/arm_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew::pcc {

namespace {

// An angle beyond this has diverged, rad.
constexpr double kLargestAngle = 1e3;
// Lower bound of the stiffness of a corotated tangent, relative to the stiffest segment.
constexpr double kSoftest = 1e-3;
// Residuals are relative to at least the torque that bends a segment by this angle, rad.
constexpr double kMinAngle = 1e-5;

}  // namespace

ArmStep::ArmStep(const ArmBodyModel& model, ArmState& state, ArmPose& pose)
    : DenseStep(model.arm().coordinates(), model.own_rows(), state.memory),
      model_(model),
      state_(state),
      pose_(pose),
      equations_(model.shared_arm()),
      row_stiffness_(model) {
  const Eigen::Index n = model.arm().coordinates();
  for (VectorX* v : {&from_, &scratch_, &kept_, &new_rate_, &acceleration_}) v->setZero(n);
  min_force_ = kMinAngle * std::max(model.arm().stiffness().maxCoeff(), 1e-9);
  equations_.linearise(state.q, state.rate, acceleration_);  // allocates its workspace
}

// b = -r(q, v, a) at the end of the step, and its exact derivative A = dr/dq + (dv/dd) dr/dv +
// (da/dd) H, without the geometric stiffness of rows (add_row_stiffness()). A is unsymmetric if the
// arm moves.
double ArmStep::form(const mechanics::LinearisationRequest& request, VectorX& right,
                     MatrixX& matrix) {
  const auto& weights = request.weights;
  if (weights.dynamic()) {
    state_.combine(weights.velocity, new_rate_);
    state_.combine(weights.acceleration, acceleration_);
  } else {
    new_rate_.setZero();
    acceleration_.setZero();
  }
  const auto& linear = equations_.linearise(state_.q, new_rate_, acceleration_);
  right = -linear.residual;
  matrix = linear.by_position;
  if (weights.dynamic()) {
    matrix += weights.velocity.motion * linear.by_rate +
              weights.acceleration.motion * linear.by_acceleration;
  }
  const Arm& arm = model_.arm();
  scratch_.noalias() = linear.by_acceleration * acceleration_;
  double scale = min_force_ + linear.residual.norm() + scratch_.norm();
  scratch_ = arm.stiffness().cwiseProduct(state_.q);
  scale += scratch_.norm();
  return scale;
}

void ArmStep::add_row_stiffness(MatrixX& matrix) { row_stiffness_.add(state_, matrix); }

double ArmStep::softest() const { return kSoftest * model_.arm().stiffness().maxCoeff(); }

void ArmStep::drift(double time_step, VectorX& motion) const { motion = time_step * state_.rate; }

void ArmStep::site_jacobian(int site, MatrixX& result) const {
  const auto& columns = pose_.jacobian(model_.attachment(site));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    result.col(static_cast<Eigen::Index>(i)) = plain(columns[i]);
  }
}

// Angles below 1 rad are rounded like 1 rad, since their sines and cosines are.
double ArmStep::rounding_floor() const {
  const double angle = std::max(1.0, state_.q.cwiseAbs().maxCoeff());
  return std::numeric_limits<double>::epsilon() * angle *
         matrix().cwiseAbs().rowwise().sum().norm();
}

double ArmStep::proposed_move() const {
  return motion().cwiseAbs().maxCoeff() * model_.arm().length();
}

mechanics::MotionReport ArmStep::apply_motion(double scale) {
  state_.q = from_ + scale * motion();
  pose_.moved();
  mechanics::MotionReport report;
  report.largest_move = scale * proposed_move();
  report.finite = state_.q.cwiseAbs().maxCoeff() < kLargestAngle;
  return report;
}

void ArmStep::find_acceleration(const mechanics::StepWeights& weights,
                                std::span<double> acceleration) {
  state_.combine(weights.acceleration, acceleration_);
  std::ranges::copy(acceleration_, acceleration.data());
}

void ArmStep::apply_mass(std::span<const double> motion, std::span<double> result) {
  const auto count = static_cast<Eigen::Index>(size());
  Eigen::Map<VectorX>(result.data(), count).noalias() =
      equations_.mass_matrix(state_.q) * Eigen::Map<const VectorX>(motion.data(), count);
}

mechanics::StepEnd ArmStep::end_step(const mechanics::StepWeights& weights) {
  pose_.moved();
  mechanics::StepEnd end;
  if (!weights.dynamic()) {
    state_.rate.setZero();
    for (VectorX& kept : state_.history) kept.setZero();
    return end;
  }
  state_.combine(weights.velocity, new_rate_);
  const auto moment = model_.arm().damping().cwiseProduct(new_rate_);
  end.damped = moment.dot(state_.q - state_.start);
  end.damping = moment.dot(new_rate_);
  end.error = weights.error_jump * keep_motion(weights) * model_.arm().length();
  return end;
}

// Updates rate and history. @return the jump from which the error of the step is estimated.
double ArmStep::keep_motion(const mechanics::StepWeights& weights) {
  using Jump = mechanics::StepWeights::Jump;
  const VectorX& rate = state_.rate;
  state_.combine(weights.acceleration, acceleration_);
  double jump = 0.0;
  if (weights.error_of == Jump::velocity) jump = (new_rate_ - rate).cwiseAbs().maxCoeff();
  if (!state_.history.empty()) {
    VectorX &first = state_.history[0], &second = state_.history[1];
    state_.combine(weights.first, scratch_);
    state_.combine(weights.second, kept_);
    if (weights.error_of == Jump::first) jump = (scratch_ - first).cwiseAbs().maxCoeff();
    if (weights.error_of == Jump::acceleration) {
      jump = (acceleration_ - (rate - second) / weights.step_before).cwiseAbs().maxCoeff();
    }
    first = scratch_;
    second = kept_;
  }
  state_.rate = new_rate_;
  return jump;
}

void ArmStep::scale_motion(double factor) {
  state_.q = state_.start + factor * (state_.q - state_.start);
  pose_.moved();
}

void ArmStep::add_velocity(std::span<const double> change) {
  state_.rate += Eigen::Map<const VectorX>(change.data(), state_.rate.size());
  pose_.moved();
}

std::size_t ArmStep::bytes() const { return DenseStep::bytes() + 5 * sizeof(double) * size(); }

}  // namespace sinew::pcc
