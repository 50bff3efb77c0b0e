#include "sinew/pcc/arm_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::pcc {

namespace {

// An angle of so many turns has blown up.
constexpr double kLargestAngle = 1e3;
// Softest that a real-time tangent is let be, of the stiffest segment.
constexpr double kSoftest = 1e-3;
// Residuals are not judged by loads that bend a segment less than this.
constexpr double kLeastAngle = 1e-5;

std::span<const double> view(const VectorX& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
Vector3 plain(const Vec3<double>& v) { return {v.x, v.y, v.z}; }

}  // namespace

ArmBody::ArmBody(const ArmBodyModel& model, int histories)
    : model_(model),
      equations_(model.shared_arm()),
      kinematics_(model.shared_arm()),
      slopes_(model.shared_arm()),
      decomposed_(model.arm().coordinates()),
      pivots_(model.arm().coordinates()),
      spectrum_(model.arm().coordinates()) {
  const Eigen::Index n = model.arm().coordinates();
  const auto rows = static_cast<Eigen::Index>(model.rows_.size());
  for (VectorX* v : {&q_, &rate_, &start_, &right_, &motion_, &base_, &scratch_, &new_rate_,
                     &acceleration_, &imbalance_}) {
    v->setZero(n);
  }
  history_.assign(static_cast<std::size_t>(histories), VectorX::Zero(n));
  for (MatrixX* m : {&matrix_, &symmetric_}) m->setZero(n, n);
  for (MatrixX* m : {&first_jacobian_, &second_jacobian_, &pulled_}) m->setZero(3, n);
  rows_.setZero(n, rows);
  moved_rows_.setZero(n, rows);
  compliance_.setZero(rows, rows);
  free_motion_.setZero(rows);
  effort_.setZero(rows);
  directions_.assign(model.entries_.size(), Vector3::Zero());
  columns_.resize(static_cast<std::size_t>(n));
  slope_columns_.resize(columns_.size());
  slope_q_.resize(columns_.size());
  least_force_ = kLeastAngle * std::max(model.arm().stiffness().maxCoeff(), 1e-9);
  force_scale_ = least_force_;
  look();
  rest_gravity_energy_ = kinematics_.gravity_energy();
  equations_.linearise(q_, rate_, acceleration_);  // takes its workspace now
  const Eigen::Index nodes = model.skin_.nodes.rows();
  shown_.setZero(nodes, 3);
  shown_velocities_.setZero(nodes, 3);
}

void ArmBody::look() const {
  if (looking_) return;
  kinematics_.set(view(q_), view(rate_), view(rate_));
  looking_ = true;
}

Vector3 ArmBody::position(int point) const {
  const auto& attachment = model_.attachments_[static_cast<std::size_t>(point)];
  if (attachment.coordinate >= 0) return {q_[attachment.coordinate], 0.0, 0.0};
  look();
  return plain(kinematics_.position(attachment.point));
}

Vector3 ArmBody::velocity(int point) const {
  const auto& attachment = model_.attachments_[static_cast<std::size_t>(point)];
  if (attachment.coordinate >= 0) return {rate_[attachment.coordinate], 0.0, 0.0};
  look();
  return plain(kinematics_.velocity(attachment.point));
}

void ArmBody::combine(const mechanics::Combination& weights, VectorX& result) const {
  result = weights.motion * (q_ - start_) + weights.velocity * rate_;
  if (history_.empty()) return;
  result += weights.first * history_[0] + weights.second * history_[1];
}

// b = -r(q, v, a) at the step's end, A = dr/dq + (dv/dd) dr/dv + (da/dd) H: the derivative, exact
// but for what rows pull (add_curvature), and unsymmetric where the arm moves.
void ArmBody::linearise(const mechanics::LinearisationRequest& request) {
  const auto& weights = request.weights;
  definite_wanted_ = request.tangent == mechanics::Tangent::real_time;
  iterating_ = request.iterating;
  if (weights.dynamic()) {
    combine(weights.velocity, new_rate_);
    combine(weights.acceleration, acceleration_);
  } else {
    new_rate_.setZero();
    acceleration_.setZero();
  }
  const auto& linear = equations_.linearise(q_, new_rate_, acceleration_);
  right_ = -linear.residual;
  matrix_ = linear.by_position;
  if (weights.dynamic()) {
    matrix_ += weights.velocity.motion * linear.by_rate +
               weights.acceleration.motion * linear.by_acceleration;
  }
  const Arm& arm = model_.arm();
  scratch_.noalias() = linear.by_acceleration * acceleration_;
  force_scale_ = least_force_ + linear.residual.norm() + scratch_.norm();
  scratch_ = arm.stiffness().cwiseProduct(q_);
  force_scale_ += scratch_.norm();
  if (imbalance_share_ != 0.0) right_ -= imbalance_share_ * imbalance_;
  stiffen_by_rows();
}

// Points move on curves: what rows pull with changes as the arm bends even where its direction
// stays, A -= sum over entries of effort direction . d2x/dq2, at the efforts and directions known
// last.
void ArmBody::stiffen_by_rows() {
  if (effort_.size() == 0 || effort_.isZero(0.0)) return;
  const std::size_t n = slope_q_.size();
  for (std::size_t k = 0; k < n; ++k) slope_q_[k] = q_[static_cast<Eigen::Index>(k)];
  const auto direction = [&](std::size_t k) -> Dual<8>::Lanes& { return slope_q_[k].grad; };
  in_passes<8>(n, direction, [&](std::size_t from, std::size_t used) {
    slopes_.place(slope_q_);
    for (std::size_t e = 0; e < model_.entries_.size(); ++e) {
      const auto& entry = model_.entries_[e];
      const auto& attachment = model_.attachments_[static_cast<std::size_t>(entry.attachment)];
      const double effort = effort_[entry.row];
      if (effort == 0.0 || attachment.coordinate >= 0) continue;
      const Vector3 pull = effort * directions_[e];
      slopes_.jacobian(attachment.point, slope_columns_);
      for (std::size_t i = 0; i < n; ++i) {
        const auto& column = slope_columns_[i];
        for (std::size_t d = 0; d < used; ++d) {
          matrix_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(from + d)) -=
              pull.x() * column.x.grad[d] + pull.y() * column.y.grad[d] +
              pull.z() * column.z.grad[d];
        }
      }
    }
  });
}

void ArmBody::point_jacobian(int point, MatrixX& result) {
  const auto& attachment = model_.attachments_[static_cast<std::size_t>(point)];
  result.setZero();
  if (attachment.coordinate >= 0) {
    result(0, attachment.coordinate) = 1.0;
    return;
  }
  look();
  kinematics_.jacobian(attachment.point, columns_);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    result.col(static_cast<Eigen::Index>(i)) = plain(columns_[i]);
  }
}

void ArmBody::add_curvature(const mechanics::RowCurvature& curvature) {
  point_jacobian(curvature.first.point, first_jacobian_);
  point_jacobian(curvature.second.point, second_jacobian_);
  pulled_.noalias() = curvature.curvature * second_jacobian_;
  symmetric_.noalias() = first_jacobian_.transpose() * pulled_;
  matrix_ -= symmetric_;
  if (curvature.first.point != curvature.second.point) matrix_ -= symmetric_.transpose();
}

void ArmBody::take_rows(const mechanics::RowValues& rows) {
  rows_.setZero();
  look();
  for (std::size_t e = 0; e < model_.entries_.size(); ++e) {
    const auto& entry = model_.entries_[e];
    const auto& attachment = model_.attachments_[static_cast<std::size_t>(entry.attachment)];
    const Vector3& direction = rows.direction[static_cast<std::size_t>(entry.entry)];
    directions_[e] = direction;
    if (attachment.coordinate >= 0) {
      rows_(attachment.coordinate, entry.row) += direction.x();
      continue;
    }
    kinematics_.jacobian(attachment.point, columns_);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      rows_(static_cast<Eigen::Index>(i), entry.row) += direction.dot(plain(columns_[i]));
    }
  }
}

void ArmBody::retake_rows(const mechanics::RowValues& rows) {
  take_rows(rows);
  respond();
}

double ArmBody::residual(std::span<const double> effort) {
  for (std::size_t k = 0; k < model_.rows_.size(); ++k) {
    effort_[static_cast<Eigen::Index>(k)] = effort[static_cast<std::size_t>(model_.rows_[k])];
  }
  scratch_ = right_;
  scratch_.noalias() += rows_ * effort_;
  return scratch_.norm();
}

// A turn of 1 is the least that angles are rounded by: their sines and cosines are.
double ArmBody::rounding_floor() const {
  const double angle = std::max(1.0, q_.cwiseAbs().maxCoeff());
  return std::numeric_limits<double>::epsilon() * angle * matrix_.cwiseAbs().rowwise().sum().norm();
}

linalg::FactorStatus ArmBody::condense() {
  symmetric_ = 0.5 * (matrix_ + matrix_.transpose());
  pivots_.compute(symmetric_);
  negative_pivots_ = pivots_.negative();
  if (negative_pivots_ > 0 && definite_wanted_) make_definite();
  decomposed_.compute(matrix_);
  respond();
  if (!moved_rows_.allFinite() || pivots_.vanishes()) {
    return linalg::FactorStatus::singular;
  }
  return negative_pivots_ > 0 ? linalg::FactorStatus::indefinite
                              : linalg::FactorStatus::positive_definite;
}

void ArmBody::respond() {
  decomposed_.solve(rows_, moved_rows_);
  if (rows_.cols() == 0) return;
  decomposed_.solve(right_, motion_);
  free_motion_.noalias() = rows_.transpose() * motion_;
  compliance_.noalias() = rows_.transpose() * moved_rows_;
}

// In the directions in which the arm would buckle the real-time tangent is as stiff as it is soft
// there: a law's program must be convex, and a step must go downhill.
void ArmBody::make_definite() {
  spectrum_.compute(symmetric_);
  const double floor = kSoftest * model_.arm().stiffness().maxCoeff();
  for (Eigen::Index i = 0; i < q_.size(); ++i) {
    const double value = spectrum_.values()[i];
    if (value >= floor) break;  // ascending
    const auto direction = spectrum_.vectors().col(i);
    matrix_.noalias() += (std::max(-value, floor) - value) * direction * direction.transpose();
  }
  negative_pivots_ = 0;
}

// The law's programs want a symmetric W: gyroscopic terms, of the order of h times the rates, are
// averaged out of it here but not of the motion. Newton's iterations would then end where the law
// holds of the averaged W alone, off by (W - W_sym) lambda of what it holds; the free motion takes
// that difference at the efforts known last, and in the limit the law holds of the motion.
void ArmBody::add_compliance(std::span<const int> place, MatrixX& compliance,
                             VectorX& free_motion) const {
  const auto& rows = model_.rows_;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const int across = place[static_cast<std::size_t>(rows[j])];
    free_motion[across] += free_motion_[column];
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const int down = place[static_cast<std::size_t>(rows[i])];
      const double mean = 0.5 * (compliance_(row, column) + compliance_(column, row));
      compliance(down, across) += mean;
      if (iterating_) free_motion[down] += (compliance_(row, column) - mean) * effort_[column];
    }
  }
}

void ArmBody::hold_imbalance(std::span<const double> effort) {
  residual(effort);
  imbalance_ = scratch_;
}

void ArmBody::solve_motion(std::span<const double> effort) {
  residual(effort);
  decomposed_.solve(scratch_, motion_);
  base_ = q_;
}

void ArmBody::imbalance(std::span<const double> effort, std::span<double> result) {
  residual(effort);
  std::copy_n(scratch_.data(), scratch_.size(), result.data());
}

void ArmBody::solve(std::span<const double> right, std::span<double> result) {
  scratch_ = Eigen::Map<const VectorX>(right.data(), q_.size());
  decomposed_.solve(scratch_, Eigen::Map<VectorX>(result.data(), q_.size()));
}

void ArmBody::propose_motion(std::span<const double> motion) {
  std::ranges::copy(motion, motion_.data());
  base_ = q_;
}

void ArmBody::propose_drift(double time_step) {
  motion_ = time_step * rate_;
  base_ = q_;
}

mechanics::MotionReport ArmBody::apply_motion(double scale) {
  q_ = base_ + scale * motion_;
  looking_ = showing_ = false;
  mechanics::MotionReport report;
  report.largest_move = scale * motion_.cwiseAbs().maxCoeff() * model_.arm().length();
  report.finite = q_.cwiseAbs().maxCoeff() < kLargestAngle;
  return report;
}

double ArmBody::end_step(const mechanics::StepWeights& weights) {
  using Jump = mechanics::StepWeights::Jump;
  looking_ = showing_ = false;
  work_ = {};
  if (!weights.dynamic()) {
    rate_.setZero();
    for (VectorX& kept : history_) kept.setZero();
    return 0.0;
  }
  combine(weights.velocity, new_rate_);
  work_.damped = model_.arm().damping().cwiseProduct(new_rate_).dot(q_ - start_);
  combine(weights.acceleration, acceleration_);
  double jump = 0.0;
  if (weights.error_of == Jump::velocity) jump = (new_rate_ - rate_).cwiseAbs().maxCoeff();
  if (!history_.empty()) {
    combine(weights.first, scratch_);
    combine(weights.second, motion_);
    if (weights.error_of == Jump::first) jump = (scratch_ - history_[0]).cwiseAbs().maxCoeff();
    if (weights.error_of == Jump::acceleration) {
      jump = (acceleration_ - (rate_ - history_[1]) / weights.step_before).cwiseAbs().maxCoeff();
    }
    history_[0] = scratch_;
    history_[1] = motion_;
  }
  rate_ = new_rate_;
  return weights.error_jump * jump * model_.arm().length();
}

void ArmBody::restart() {
  q_.setZero();
  rate_.setZero();
  effort_.setZero();
  for (VectorX& kept : history_) kept.setZero();
  looking_ = showing_ = false;
}

void ArmBody::set_coordinates(const VectorX& q, const VectorX& rate) {
  if (q.size() != q_.size() || rate.size() != q_.size()) {
    throw Error(ErrorKind::wrong_shape, {.item = "body '" + model_.name() + "'"},
                fmt::format("{} coordinates and {} rates", q.size(), rate.size()),
                fmt::format("give {} of each", q_.size()));
  }
  restart();
  q_ = q;
  rate_ = rate;
}

std::size_t ArmBody::state_size() const {
  return (2 + history_.size()) * static_cast<std::size_t>(q_.size()) +
         static_cast<std::size_t>(effort_.size()) + 3 * directions_.size();
}

// Efforts and directions are part of it: the next step's matrix looks at them.
void ArmBody::save_state(std::span<double> state) const {
  double* to = std::copy_n(q_.data(), q_.size(), state.data());
  to = std::copy_n(rate_.data(), rate_.size(), to);
  for (const VectorX& kept : history_) to = std::copy_n(kept.data(), kept.size(), to);
  to = std::copy_n(effort_.data(), effort_.size(), to);
  for (const Vector3& direction : directions_) to = std::copy_n(direction.data(), 3, to);
}

void ArmBody::load_state(std::span<const double> state) {
  const double* from = state.data();
  const auto take = [&](double* to, Eigen::Index count) {
    std::copy_n(from, count, to);
    from += count;
  };
  take(q_.data(), q_.size());
  take(rate_.data(), rate_.size());
  for (VectorX& kept : history_) take(kept.data(), kept.size());
  take(effort_.data(), effort_.size());
  for (Vector3& direction : directions_) take(direction.data(), 3);
  looking_ = showing_ = false;
}

double ArmBody::strain_energy() {
  look();
  return kinematics_.strain_energy();
}
double ArmBody::kinetic_energy() {
  look();
  return kinematics_.kinetic_energy();
}
double ArmBody::gravity_energy() const {
  look();
  return kinematics_.gravity_energy() - rest_gravity_energy_;
}

std::size_t ArmBody::bytes() const {
  const Eigen::Index numbers = 3 * q_.size() * q_.size() + 3 * rows_.size() + compliance_.size() +
                               2 * shown_.size() + 12 * q_.size();
  return sizeof(double) * static_cast<std::size_t>(numbers);
}

void ArmBody::show() const {
  if (showing_) return;
  look();
  for (Eigen::Index i = 0; i < shown_.rows(); ++i) {
    const ArmPoint& point = model_.skin_points_[static_cast<std::size_t>(i)];
    shown_.row(i) = plain(kinematics_.position(point)).transpose();
    shown_velocities_.row(i) = plain(kinematics_.velocity(point)).transpose();
  }
  showing_ = true;
}

const Points& ArmBody::positions() const {
  show();
  return shown_;
}

const Points& ArmBody::velocities() const {
  show();
  return shown_velocities_;
}

}  // namespace sinew::pcc
