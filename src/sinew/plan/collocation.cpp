#include "sinew/plan/collocation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sinew::plan {

namespace {

std::vector<pcc::ArmPoint> backbone(const pcc::Arm& arm, int points) {
  std::vector<pcc::ArmPoint> result;
  for (int s = 0; s < arm.segments(); ++s) {
    if (arm.settings().segments[static_cast<std::size_t>(s)].dead_length > 0.0) {
      result.push_back({s, 0.0});
    }
    for (int i = 1; i <= points; ++i) {
      result.push_back({s, static_cast<double>(i) / static_cast<double>(points)});
    }
  }
  return result;
}

}  // namespace

Collocation::Collocation(std::shared_ptr<const pcc::Arm> arm, PlanTask task)
    : arm_(std::move(arm)),
      task_(std::move(task)),
      grid_(task_.grid),
      begins_(VectorX::Zero(grid_.intervals + 1)),
      equations_(arm_),
      points_(arm_),
      tip_{arm_->segments() - 1},
      n_(arm_->coordinates()),
      inputs_(arm_->inputs()) {
  for (int k = 0; k < grid_.intervals; ++k) begins_[k + 1] = begins_[k] + grid_.fractions[k];
  const Transcription unit(grid_.method, 1.0);
  blocks_ = unit.blocks;
  stages_ = static_cast<int>(unit.stages.size());
  defects_ = unit.defects();
  knot_size_ = blocks_ * n_ + (task_.drive ? 0 : inputs_);
  variables_ = (grid_.intervals + 1) * knot_size_ + (grid_.free() ? 1 : 0);
  if (!task_.obstacles.empty()) backbone_ = backbone(*arm_, task_.backbone_points);
  rate_limited_ = task_.limits.torque_rate.minCoeff() < kNoBound;
  speed_limited_ = task_.goal.speed_tolerance < kNoBound;
  const auto clearances = static_cast<int>(backbone_.size() * task_.obstacles.size());
  rows_ = clearance_row(0) + clearances;
  const double torque = typical_torque();
  if (task_.drive) {
    drive_ = std::make_unique<const DriveTranscription>(task_, torque, variables_, drive_row());
    variables_ += drive_->variables();
  }
  set_bounds();
  set_aim({.clearance = VectorX::Zero(static_cast<Eigen::Index>(task_.obstacles.size()))});
  set_scales(torque);
  note_patterns();
}

void Collocation::set_bounds() {
  const ArmLimits& limits = task_.limits;
  variable_bounds_ = {VectorX::Constant(variables_, -kNoBound),
                      VectorX::Constant(variables_, kNoBound)};
  for (int k = 0; k <= grid_.intervals; ++k) {
    variable_bounds_.lower.segment(knot(k), n_) = limits.angle_lower;
    variable_bounds_.upper.segment(knot(k), n_) = limits.angle_upper;
    variable_bounds_.lower.segment(knot(k) + n_, n_) = -limits.rate;
    variable_bounds_.upper.segment(knot(k) + n_, n_) = limits.rate;
    if (drive_) continue;
    variable_bounds_.lower.segment(torque_at(k), inputs_) = limits.torque_lower;
    variable_bounds_.upper.segment(torque_at(k), inputs_) = limits.torque_upper;
  }
  for (VectorX* bound : {&variable_bounds_.lower, &variable_bounds_.upper}) {
    bound->segment(0, n_) = task_.start.position;
    bound->segment(n_, n_) = task_.start.rate;
    // The acceleration of the first knot is not used.
    if (blocks_ == 3) bound->segment(2 * n_, n_).setZero();
    if (!drive_) bound->segment(torque_at(0), inputs_) = task_.start.torque;
  }
  if (grid_.free()) {
    variable_bounds_.lower[time_at()] = grid_.min_duration;
    variable_bounds_.upper[time_at()] = grid_.max_duration;
  }
  const int rows = drive_row() + (drive_ ? drive_->rows() : 0);
  constraint_bounds_ = {VectorX::Zero(rows), VectorX::Zero(rows)};
  for (int k = 0; k < grid_.intervals; ++k) {
    if (rate_limited_) {
      constraint_bounds_.lower.segment(rate_row(k), inputs_) = -limits.torque_rate;
      constraint_bounds_.upper.segment(rate_row(k), inputs_) = limits.torque_rate;
    }
    constraint_bounds_.upper.segment(clearance_row(k), row(k + 1) - clearance_row(k))
        .setConstant(kNoBound);
  }
  constraint_bounds_.lower[goal_row()] = -kNoBound;
  if (speed_limited_) constraint_bounds_.lower[speed_row()] = -kNoBound;
  if (!drive_) return;
  variable_bounds_.lower.tail(drive_->variables()) = drive_->variable_bounds().lower;
  variable_bounds_.upper.tail(drive_->variables()) = drive_->variable_bounds().upper;
  constraint_bounds_.lower.tail(drive_->rows()) = drive_->row_bounds().lower;
  constraint_bounds_.upper.tail(drive_->rows()) = drive_->row_bounds().upper;
}

void Collocation::set_aim(const Aim& aim) {
  aim_ = aim;
  const auto points = static_cast<Eigen::Index>(backbone_.size());
  for (int k = 0; k < grid_.intervals; ++k) {
    Eigen::Index at = clearance_row(k);
    for (std::size_t o = 0; o < task_.obstacles.size(); ++o, at += points) {
      constraint_bounds_.lower.segment(at, points)
          .setConstant(task_.obstacles[o].clearance + aim.clearance[static_cast<Eigen::Index>(o)]);
    }
  }
  const auto at_most = [&](double tolerance) {
    return std::sqrt(2.0) * (1.0 - aim.reserve) * tolerance;
  };
  constraint_bounds_.upper[goal_row()] = at_most(task_.goal.tolerance);
  if (speed_limited_) constraint_bounds_.upper[speed_row()] = at_most(task_.goal.speed_tolerance);
}

SmoothLength Collocation::distance(const Vector3& tip) const {
  return {tip + aim_.position - task_.goal.position, (1.0 - aim_.reserve) * task_.goal.tolerance};
}

SmoothLength Collocation::speed(const Vector3& velocity) const {
  return {velocity + aim_.velocity, (1.0 - aim_.reserve) * task_.goal.speed_tolerance};
}

double Collocation::typical_torque() {
  const double most = std::max(task_.limits.torque_upper.cwiseAbs().maxCoeff(),
                               task_.limits.torque_lower.cwiseAbs().maxCoeff());
  if (most < kNoBound) return std::max(most, 1e-9);
  const VectorX zero = VectorX::Zero(n_);
  const auto& linear = equations_.linearise(task_.start.position, zero, zero);
  return std::max(linear.by_position.cwiseAbs().diagonal().mean(), 1e-9);
}

void Collocation::set_scales(double torque) {
  // The time scale is that of the arm: inertia over stiffness, including that of gravity.
  const VectorX zero = VectorX::Zero(n_);
  const auto& linear = equations_.linearise(task_.start.position, zero, zero);
  const double stiffness = linear.by_position.cwiseAbs().diagonal().sum();
  const double own = std::sqrt(linear.by_acceleration.trace() / std::max(stiffness, 1e-12));
  variable_scale_ = VectorX::Ones(variables_);
  for (int k = 0; k <= grid_.intervals; ++k) {
    double unit = 1.0;
    for (int b = 0; b < blocks_; ++b, unit /= own) {
      variable_scale_.segment(knot(k) + b * n_, n_).setConstant(unit);
    }
    if (!drive_) variable_scale_.segment(torque_at(k), inputs_).setConstant(torque);
  }
  const double length = arm_->length();
  constraint_scale_ = VectorX::Ones(constraints());
  for (int k = 0; k < grid_.intervals; ++k) {
    constraint_scale_.segment(row(k), n_ * defects_)
        .setConstant(grid_.duration * grid_.fractions[k] / own);
    constraint_scale_.segment(stage_row(k, 0), rate_row(k) - stage_row(k, 0)).setConstant(torque);
    constraint_scale_.segment(rate_row(k), clearance_row(k) - rate_row(k))
        .setConstant(torque / own);
    constraint_scale_.segment(clearance_row(k), row(k + 1) - clearance_row(k)).setConstant(length);
  }
  constraint_scale_[goal_row()] = 0.1 * length;
  if (speed_limited_) constraint_scale_[speed_row()] = 0.1 * length / own;
  if (drive_) {
    variable_scale_.tail(drive_->variables()) = drive_->variable_scale();
    constraint_scale_.tail(drive_->rows()) = drive_->row_scale();
  }
  const Objective& cost = task_.objective;
  // Typical plans cost a tenth of what the limits on torque allow.
  objective_scale_ =
      0.1 * std::max({cost.effort * torque * torque * grid_.duration,
                      cost.tip_speed * std::pow(0.1 * length / own, 2), cost.time * own, 1e-12});
}

MatrixX Collocation::pair(const VectorX& x, int k) const {
  MatrixX result(n_, 2 * blocks_);
  for (int b = 0; b < blocks_; ++b) {
    result.col(b) = x.segment(knot(k) + b * n_, n_);
    result.col(blocks_ + b) = x.segment(knot(k + 1) + b * n_, n_);
  }
  return result;
}

VectorX Collocation::state(const VectorX& x, int k, int block) const {
  return x.segment(knot(k) + block * n_, n_);
}

double Collocation::duration(const VectorX& x) const {
  return grid_.free() ? x[time_at()] : grid_.duration;
}

const std::vector<Transcription>& Collocation::rules(const VectorX& x) const {
  if (const double now = duration(x); now != rules_duration_) {
    rules_.clear();
    for (const double fraction : grid_.fractions) rules_.emplace_back(grid_.method, fraction * now);
    rules_duration_ = now;
  }
  return rules_;
}

const VectorDerivatives& Collocation::tip_position(const VectorX& x) {
  return points_.positions(state(x, grid_.intervals, 0), {tip_}).front();
}

const VectorDerivatives& Collocation::tip_velocity(const VectorX& x) {
  return points_.velocity(state(x, grid_.intervals, 0), state(x, grid_.intervals, 1), tip_);
}

LinearForm Collocation::input(int k, double fraction, int u) const {
  if (drive_)
    return drive_->volume(u, (begins_[k] + fraction * grid_.fractions[k]) * grid_.duration);
  return {{torque_at(k) + u, torque_at(k + 1) + u}, {1.0 - fraction, fraction}, 2};
}

Collocation::Response Collocation::response(const VectorX& x, const LinearForm& form, int u) const {
  const double value = form.of(x);
  if (!drive_) return {value, 1.0, 0.0};
  const auto& actuator = task_.drive->channels[static_cast<std::size_t>(u)].actuator;
  return {actuator.torque(value), actuator.slope(value), actuator.curvature(value)};
}

VectorX Collocation::torque(const VectorX& x, int k, double fraction) const {
  VectorX result(inputs_);
  for (int u = 0; u < inputs_; ++u) result[u] = response(x, input(k, fraction, u), u).torque;
  return result;
}

VectorX Collocation::torque(const VectorX& x, int k) const {
  return k < grid_.intervals ? torque(x, k, 0.0) : torque(x, k - 1, 1.0);
}

double Collocation::objective(const VectorX& x) {
  double effort = 0.0;
  each_effort_point(x, [&](int k, double fraction, double weight) {
    effort += weight * torque(x, k, fraction).squaredNorm();
  });
  const Objective& cost = task_.objective;
  double result = cost.effort * duration(x) * effort;
  if (cost.tip_speed > 0.0) result += cost.tip_speed * tip_velocity(x).value.squaredNorm();
  if (grid_.free()) result += cost.time * duration(x);
  if (!drive_) return result;
  for (const auto& [row, column, value] : drive_->cost_hessian()) {
    result += (row == column ? 0.5 : 1.0) * value * x[row] * x[column];
  }
  return result;
}

void Collocation::gradient(const VectorX& x, VectorX& result) {
  const Objective& cost = task_.objective;
  result.setZero(variables_);
  each_effort_point(x, [&](int k, double fraction, double weight) {
    const double per = cost.effort * weight;
    for (int u = 0; u < inputs_; ++u) {
      const LinearForm form = input(k, fraction, u);
      const Response of = response(x, form, u);
      for (std::size_t i = 0; i < static_cast<std::size_t>(form.count); ++i) {
        result[form.at[i]] += 2.0 * per * duration(x) * of.torque * of.slope * form.weight[i];
      }
      if (grid_.free()) result[time_at()] += per * of.torque * of.torque;
    }
  });
  if (cost.tip_speed > 0.0) {
    const auto& velocity = tip_velocity(x);
    result.segment(knot(grid_.intervals), 2 * n_) +=
        2.0 * cost.tip_speed * velocity.jacobian.transpose() * velocity.value;
  }
  if (grid_.free()) result[time_at()] += cost.time;
  if (!drive_) return;
  for (const auto& [row, column, value] : drive_->cost_hessian()) {
    result[row] += value * x[column];
    if (row != column) result[column] += value * x[row];
  }
}

void Collocation::constraints(const VectorX& x, VectorX& result) {
  result.resize(constraints());
  const std::vector<Transcription>& all = rules(x);
  const MatrixX& actuation = arm_->actuation();
  for (int k = 0; k < grid_.intervals; ++k) {
    const Transcription& rules = all[static_cast<std::size_t>(k)];
    const MatrixX knots = pair(x, k);
    result.segment(row(k), n_ * defects_).reshaped(n_, defects_) =
        knots * rules.defect.value.transpose();
    for (std::size_t s = 0; s < rules.stages.size(); ++s) {
      const CollocationStage& stage = rules.stages[s];
      const MatrixX motion = knots * stage.state.value.transpose();
      result.segment(stage_row(k, static_cast<int>(s)), n_) =
          equations_.residual(motion.col(0), motion.col(1), motion.col(2)) -
          actuation * torque(x, k, stage.time);
    }
    if (rate_limited_) {
      result.segment(rate_row(k), inputs_) =
          (torque(x, k + 1) - torque(x, k)) / (grid_.fractions[k] * duration(x));
    }
    if (task_.obstacles.empty()) continue;
    const auto& where = points_.positions(state(x, k + 1, 0), backbone_);
    int at = clearance_row(k);
    for (const Obstacle& obstacle : task_.obstacles) {
      for (const VectorDerivatives& point : where) result[at++] = obstacle.distance(point.value);
    }
  }
  result[goal_row()] = distance(tip_position(x).value).value;
  if (speed_limited_) result[speed_row()] = speed(tip_velocity(x).value).value;
  if (!drive_) return;
  result.tail(drive_->rows()).setZero();
  for (const auto& [row, column, value] : drive_->jacobian()) result[row] += value * x[column];
}

VectorX Collocation::pack(const Knots& knots) const {
  VectorX x(variables_);
  for (int k = 0; k <= grid_.intervals; ++k) {
    x.segment(knot(k), n_) = knots.position.row(k);
    x.segment(knot(k) + n_, n_) = knots.rate.row(k);
    if (blocks_ == 3) x.segment(knot(k) + 2 * n_, n_) = knots.acceleration.row(k);
    if (!drive_) x.segment(torque_at(k), inputs_) = knots.torque.row(k);
  }
  if (drive_) x.tail(drive_->variables()) = drive_->pack(knots.drive.value());
  if (grid_.free()) x[time_at()] = knots.times[knots.times.size() - 1];
  return x;
}

Knots Collocation::unpack(const VectorX& x) const {
  const int count = grid_.intervals + 1;
  Knots knots{duration(x) * begins_,    MatrixX(count, n_),      MatrixX(count, n_),
              MatrixX::Zero(count, n_), MatrixX(count, inputs_), {}};
  if (drive_) knots.drive = drive_->unpack(x);
  for (int k = 0; k < count; ++k) {
    knots.position.row(k) = state(x, k, 0);
    knots.rate.row(k) = state(x, k, 1);
    if (blocks_ == 3) {
      knots.acceleration.row(k) = state(x, k, 2);
    } else if (k > 0) {
      knots.acceleration.row(k) =
          (knots.rate.row(k) - knots.rate.row(k - 1)) / (knots.times[k] - knots.times[k - 1]);
    }
    knots.torque.row(k) = torque(x, k);
  }
  return knots;
}

}  // namespace sinew::plan
