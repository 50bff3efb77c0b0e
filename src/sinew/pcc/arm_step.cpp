#include "sinew/pcc/arm_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew::pcc {

namespace {

// An angle of so many turns has blown up.
constexpr double kLargestAngle = 1e3;
// Softest that a real-time tangent is let be, of the stiffest segment.
constexpr double kSoftest = 1e-3;
// Residuals are not judged by loads that bend a segment less than this.
constexpr double kMinAngle = 1e-5;

}  // namespace

ArmStep::ArmStep(const ArmBodyModel& model, ArmState& state, ArmPose& pose)
    : model_(model),
      state_(state),
      pose_(pose),
      equations_(model.shared_arm()),
      row_stiffness_(model),
      decomposed_(model.arm().coordinates()),
      pivots_(model.arm().coordinates()),
      spectrum_(model.arm().coordinates()) {
  const Eigen::Index n = model.arm().coordinates();
  const auto rows = static_cast<Eigen::Index>(model.rows().size());
  for (VectorX* v :
       {&right_, &motion_, &from_, &scratch_, &new_rate_, &acceleration_, &lessening_}) {
    v->setZero(n);
  }
  for (MatrixX* m : {&matrix_, &symmetric_}) m->setZero(n, n);
  for (MatrixX* m : {&first_jacobian_, &second_jacobian_, &pulled_}) m->setZero(3, n);
  rows_.setZero(n, rows);
  moved_rows_.setZero(n, rows);
  compliance_.setZero(rows, rows);
  free_motion_.setZero(rows);
  least_force_ = kMinAngle * std::max(model.arm().stiffness().maxCoeff(), 1e-9);
  force_scale_ = least_force_;
  equations_.linearise(state.q, state.rate, acceleration_);  // takes its workspace now
}

// b = -r(q, v, a) at the step's end, A = dr/dq + (dv/dd) dr/dv + (da/dd) H: the derivative, exact
// but for what rows pull (add_curvature), and unsymmetric where the arm moves.
void ArmStep::linearise(const mechanics::LinearisationRequest& request) {
  const auto& weights = request.weights;
  definite_wanted_ = request.tangent == mechanics::Tangent::rotated;
  iterating_ = request.iterating;
  if (weights.dynamic()) {
    state_.combine(weights.velocity, new_rate_);
    state_.combine(weights.acceleration, acceleration_);
  } else {
    new_rate_.setZero();
    acceleration_.setZero();
  }
  const auto& linear = equations_.linearise(state_.q, new_rate_, acceleration_);
  right_ = -linear.residual;
  matrix_ = linear.by_position;
  if (weights.dynamic()) {
    matrix_ += weights.velocity.motion * linear.by_rate +
               weights.acceleration.motion * linear.by_acceleration;
  }
  const Arm& arm = model_.arm();
  scratch_.noalias() = linear.by_acceleration * acceleration_;
  force_scale_ = least_force_ + linear.residual.norm() + scratch_.norm();
  scratch_ = arm.stiffness().cwiseProduct(state_.q);
  force_scale_ += scratch_.norm();
  if (lessens_) right_ -= lessening_;
  row_stiffness_.add(state_, matrix_);
}

void ArmStep::site_jacobian(int site, MatrixX& result) {
  const auto& columns = pose_.jacobian(model_.attachment(site));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    result.col(static_cast<Eigen::Index>(i)) = plain(columns[i]);
  }
}

void ArmStep::add_curvature(const mechanics::RowCurvature& curvature) {
  site_jacobian(curvature.first.number, first_jacobian_);
  site_jacobian(curvature.second.number, second_jacobian_);
  pulled_.noalias() = curvature.curvature * second_jacobian_;
  symmetric_.noalias() = first_jacobian_.transpose() * pulled_;
  matrix_ -= symmetric_;
  if (curvature.first.number != curvature.second.number) matrix_ -= symmetric_.transpose();
}

void ArmStep::take_rows(const mechanics::RowValues& rows) {
  rows_.setZero();
  for (std::size_t e = 0; e < model_.entries().size(); ++e) {
    const auto& entry = model_.entries()[e];
    const Vector3& direction = rows.direction[static_cast<std::size_t>(entry.entry)];
    state_.directions[e] = direction;
    const auto& columns = pose_.jacobian(model_.attachment(entry.attachment));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      rows_(static_cast<Eigen::Index>(i), entry.row) += direction.dot(plain(columns[i]));
    }
  }
}

void ArmStep::retake_rows(const mechanics::RowValues& rows) {
  take_rows(rows);
  respond();
}

void ArmStep::find_imbalance(std::span<const double> effort) {
  for (std::size_t k = 0; k < model_.rows().size(); ++k) {
    state_.effort[static_cast<Eigen::Index>(k)] =
        effort[static_cast<std::size_t>(model_.rows()[k])];
  }
  scratch_ = right_;
  scratch_.noalias() += rows_ * state_.effort;
}

double ArmStep::residual(std::span<const double> effort, std::span<double> imbalance) {
  find_imbalance(effort);
  if (!imbalance.empty()) std::copy_n(scratch_.data(), scratch_.size(), imbalance.data());
  return scratch_.norm();
}

void ArmStep::lessen(std::span<const double> force) {
  lessens_ = !force.empty();
  if (lessens_) lessening_ = Eigen::Map<const VectorX>(force.data(), right_.size());
}

// A turn of 1 is the least that angles are rounded by: their sines and cosines are.
double ArmStep::rounding_floor() const {
  const double angle = std::max(1.0, state_.q.cwiseAbs().maxCoeff());
  return std::numeric_limits<double>::epsilon() * angle * matrix_.cwiseAbs().rowwise().sum().norm();
}

mechanics::Inertia ArmStep::condense() {
  symmetric_ = 0.5 * (matrix_ + matrix_.transpose());
  pivots_.compute(symmetric_);
  mechanics::Inertia inertia;
  inertia.negative_pivots = pivots_.negative();
  if (inertia.negative_pivots > 0 && definite_wanted_) {
    make_definite();
    inertia.negative_pivots = 0;
  }
  decomposed_.compute(matrix_);
  respond();
  if (inertia.negative_pivots > 0) inertia.status = linalg::FactorStatus::indefinite;
  if (!moved_rows_.allFinite() || pivots_.vanishes()) {
    inertia.status = linalg::FactorStatus::singular;
  }
  return inertia;
}

void ArmStep::respond() {
  decomposed_.solve(rows_, moved_rows_);
  if (rows_.cols() == 0) return;
  decomposed_.solve(right_, motion_);
  free_motion_.noalias() = rows_.transpose() * motion_;
  compliance_.noalias() = rows_.transpose() * moved_rows_;
}

// In the directions in which the arm would buckle the real-time tangent is as stiff as it is soft
// there: a law's program must be convex, and a step must go downhill.
void ArmStep::make_definite() {
  spectrum_.compute(symmetric_);
  const double floor = kSoftest * model_.arm().stiffness().maxCoeff();
  for (Eigen::Index i = 0; i < state_.q.size(); ++i) {
    const double value = spectrum_.values()[i];
    if (value >= floor) break;  // ascending
    const auto direction = spectrum_.vectors().col(i);
    matrix_.noalias() += (std::max(-value, floor) - value) * direction * direction.transpose();
  }
}

// The law's programs want a symmetric W: gyroscopic terms, of the order of h times the rates, are
// averaged out of it here but not of the motion. Newton's iterations would then end where the law
// holds of the averaged W alone, off by (W - W_sym) lambda of what it holds; the free motion takes
// that difference at the efforts known last, and in the limit the law holds of the motion.
void ArmStep::add_compliance(std::span<const int> place, MatrixX& compliance,
                             VectorX& free_motion) const {
  const auto& rows = model_.rows();
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const int across = place[static_cast<std::size_t>(rows[j])];
    free_motion[across] += free_motion_[column];
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const int down = place[static_cast<std::size_t>(rows[i])];
      const double mean = 0.5 * (compliance_(row, column) + compliance_(column, row));
      compliance(down, across) += mean;
      if (!iterating_) continue;
      free_motion[down] += (compliance_(row, column) - mean) * state_.effort[column];
    }
  }
}

void ArmStep::solve_motion(std::span<const double> effort) {
  find_imbalance(effort);
  decomposed_.solve(scratch_, motion_);
  from_ = state_.q;
}

void ArmStep::solve(std::span<const double> right, std::span<double> result) {
  scratch_ = Eigen::Map<const VectorX>(right.data(), state_.q.size());
  decomposed_.solve(scratch_, Eigen::Map<VectorX>(result.data(), state_.q.size()));
}

void ArmStep::propose_motion(std::span<const double> motion) {
  std::ranges::copy(motion, motion_.data());
  from_ = state_.q;
}

void ArmStep::propose_drift(double time_step) {
  motion_ = time_step * state_.rate;
  from_ = state_.q;
}

mechanics::MotionReport ArmStep::apply_motion(double scale) {
  state_.q = from_ + scale * motion_;
  pose_.moved();
  mechanics::MotionReport report;
  report.largest_move = scale * motion_.cwiseAbs().maxCoeff() * model_.arm().length();
  report.finite = state_.q.cwiseAbs().maxCoeff() < kLargestAngle;
  return report;
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
  end.damped = model_.arm().damping().cwiseProduct(new_rate_).dot(state_.q - state_.start);
  end.error = weights.error_jump * keep_motion(weights) * model_.arm().length();
  return end;
}

// @return the jump by which the step's error is judged.
double ArmStep::keep_motion(const mechanics::StepWeights& weights) {
  using Jump = mechanics::StepWeights::Jump;
  const VectorX& rate = state_.rate;
  state_.combine(weights.acceleration, acceleration_);
  double jump = 0.0;
  if (weights.error_of == Jump::velocity) jump = (new_rate_ - rate).cwiseAbs().maxCoeff();
  if (!state_.history.empty()) {
    VectorX &first = state_.history[0], &second = state_.history[1];
    state_.combine(weights.first, scratch_);
    state_.combine(weights.second, motion_);
    if (weights.error_of == Jump::first) jump = (scratch_ - first).cwiseAbs().maxCoeff();
    if (weights.error_of == Jump::acceleration) {
      jump = (acceleration_ - (rate - second) / weights.step_before).cwiseAbs().maxCoeff();
    }
    first = scratch_;
    second = motion_;
  }
  state_.rate = new_rate_;
  return jump;
}

std::size_t ArmStep::bytes() const {
  const Eigen::Index n = right_.size();
  const Eigen::Index numbers = 3 * n * n + 3 * rows_.size() + compliance_.size() + 12 * n;
  return sizeof(double) * static_cast<std::size_t>(numbers);
}

}  // namespace sinew::pcc
