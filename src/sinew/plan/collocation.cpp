#include "sinew/plan/collocation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sinew::plan {

namespace {

/// sqrt(|e|^2 + d^2) of a vector e of space.
struct SmoothLength {
  double value;
  Vector3 gradient;
  Matrix3 hessian;

  SmoothLength(const Vector3& e, double d)
      : value(std::sqrt(e.squaredNorm() + d * d)),
        gradient(e / value),
        hessian((Matrix3::Identity() - gradient * gradient.transpose()) / value) {}
};

/// Chain rule to second order: J^T H J + sum g_i H_i.
MatrixX composed(const Vector3& gradient, const Matrix3& hessian, const VectorDerivatives& inner) {
  MatrixX result = inner.jacobian.transpose() * hessian * inner.jacobian;
  for (std::size_t i = 0; i < 3; ++i) {
    result += gradient[static_cast<Eigen::Index>(i)] * inner.hessian[i];
  }
  return result;
}

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

Collocation::Collocation(std::shared_ptr<const pcc::Arm> arm, Task task)
    : arm_(std::move(arm)),
      task_(std::move(task)),
      grid_(task_.grid),
      rules_(grid_.method, grid_.duration / grid_.intervals, false),
      equations_(arm_),
      points_(arm_),
      tip_{arm_->segments() - 1},
      n_(arm_->coordinates()),
      inputs_(arm_->inputs()),
      knot_size_(rules_.blocks * n_ + inputs_),
      variables_((grid_.intervals + 1) * knot_size_ + (grid_.free() ? 1 : 0)) {
  if (!task_.obstacles.empty()) backbone_ = backbone(*arm_, task_.backbone_points);
  rate_limited_ = task_.limits.torque_rate.minCoeff() < kNoBound;
  speed_limited_ = task_.goal.speed_tolerance < kNoBound;
  const auto clearances = static_cast<int>(backbone_.size() * task_.obstacles.size());
  rows_ = clearance_row(0) + clearances;
  set_bounds();
  set_scales();
  const VectorX x = variable_scale_;
  each_jacobian_entry(x, [&](int row, int column, double) {
    jacobian_pattern_.push_back({row, column});
  });
  each_hessian_entry(x, 1.0, VectorX::Ones(constraints()), [&](int row, int column, double) {
    hessian_pattern_.push_back({row, column});
  });
}

void Collocation::set_bounds() {
  const Limits& limits = task_.limits;
  variable_bounds_ = {VectorX::Constant(variables_, -kNoBound),
                      VectorX::Constant(variables_, kNoBound)};
  for (int k = 0; k <= grid_.intervals; ++k) {
    variable_bounds_.lower.segment(knot(k), n_) = limits.angle_lower;
    variable_bounds_.upper.segment(knot(k), n_) = limits.angle_upper;
    variable_bounds_.lower.segment(knot(k) + n_, n_) = -limits.rate;
    variable_bounds_.upper.segment(knot(k) + n_, n_) = limits.rate;
    variable_bounds_.lower.segment(torque_at(k), inputs_) = limits.torque_lower;
    variable_bounds_.upper.segment(torque_at(k), inputs_) = limits.torque_upper;
  }
  for (VectorX* bound : {&variable_bounds_.lower, &variable_bounds_.upper}) {
    bound->segment(0, n_) = task_.start.position;
    bound->segment(n_, n_) = task_.start.rate;
    // The first acceleration takes no part.
    if (rules_.blocks == 3) bound->segment(2 * n_, n_).setZero();
    bound->segment(torque_at(0), inputs_) = task_.start.torque;
  }
  if (grid_.free()) {
    variable_bounds_.lower[time_at()] = grid_.least_duration;
    variable_bounds_.upper[time_at()] = grid_.most_duration;
  }
  const int rows = speed_row() + (speed_limited_ ? 1 : 0);
  constraint_bounds_ = {VectorX::Zero(rows), VectorX::Zero(rows)};
  for (int k = 0; k < grid_.intervals; ++k) {
    if (rate_limited_) {
      constraint_bounds_.lower.segment(rate_row(k), inputs_) = -limits.torque_rate;
      constraint_bounds_.upper.segment(rate_row(k), inputs_) = limits.torque_rate;
    }
    int at = clearance_row(k);
    for (const Obstacle& obstacle : task_.obstacles) {
      const auto points = static_cast<Eigen::Index>(backbone_.size());
      constraint_bounds_.lower.segment(at, points).setConstant(obstacle.clearance);
      constraint_bounds_.upper.segment(at, points).setConstant(kNoBound);
      at += static_cast<int>(points);
    }
  }
  constraint_bounds_.lower[goal_row()] = -kNoBound;
  constraint_bounds_.upper[goal_row()] = std::sqrt(2.0) * task_.goal.tolerance;
  if (speed_limited_) {
    constraint_bounds_.lower[speed_row()] = -kNoBound;
    constraint_bounds_.upper[speed_row()] = std::sqrt(2.0) * task_.goal.speed_tolerance;
  }
}

void Collocation::set_scales() {
  // Time by the arm's own: inertia over stiffness, gravity's included.
  const VectorX zero = VectorX::Zero(n_);
  const auto& linear = equations_.linearise(task_.start.position, zero, zero);
  const double stiffness = linear.by_position.cwiseAbs().diagonal().sum();
  const double own = std::sqrt(linear.by_acceleration.trace() / std::max(stiffness, 1e-12));
  const double most = std::max(task_.limits.torque_upper.cwiseAbs().maxCoeff(),
                               task_.limits.torque_lower.cwiseAbs().maxCoeff());
  const double torque =
      most < kNoBound ? std::max(most, 1e-9) : std::max(stiffness / static_cast<double>(n_), 1e-9);
  variable_scale_ = VectorX::Ones(variables_);
  for (int k = 0; k <= grid_.intervals; ++k) {
    double unit = 1.0;
    for (int b = 0; b < rules_.blocks; ++b, unit /= own) {
      variable_scale_.segment(knot(k) + b * n_, n_).setConstant(unit);
    }
    variable_scale_.segment(torque_at(k), inputs_).setConstant(torque);
  }
  const double length = arm_->length();
  constraint_scale_ = VectorX::Ones(constraints());
  for (int k = 0; k < grid_.intervals; ++k) {
    constraint_scale_.segment(row(k), n_).setConstant(grid_.duration / grid_.intervals / own);
    constraint_scale_.segment(stage_row(k, 0), rate_row(k) - stage_row(k, 0)).setConstant(torque);
    constraint_scale_.segment(rate_row(k), clearance_row(k) - rate_row(k))
        .setConstant(torque / own);
    constraint_scale_.segment(clearance_row(k), row(k + 1) - clearance_row(k)).setConstant(length);
  }
  constraint_scale_[goal_row()] = 0.1 * length;
  if (speed_limited_) constraint_scale_[speed_row()] = 0.1 * length / own;
  const Objective& cost = task_.objective;
  // A tenth of what limits on torque allow is what plans come to.
  objective_scale_ =
      0.1 * std::max({cost.effort * torque * torque * grid_.duration,
                      cost.tip_speed * std::pow(0.1 * length / own, 2), cost.time * own, 1e-12});
}

MatrixX Collocation::pair(const VectorX& x, int k) const {
  MatrixX result(n_, 2 * rules_.blocks);
  for (int b = 0; b < rules_.blocks; ++b) {
    result.col(b) = x.segment(knot(k) + b * n_, n_);
    result.col(rules_.blocks + b) = x.segment(knot(k + 1) + b * n_, n_);
  }
  return result;
}

VectorX Collocation::state(const VectorX& x, int k, int block) const {
  return x.segment(knot(k) + block * n_, n_);
}

double Collocation::duration(const VectorX& x) const {
  return grid_.free() ? x[time_at()] : grid_.duration;
}

std::array<Transcription, 2> Collocation::rules(const VectorX& x) const {
  const double h = duration(x) / grid_.intervals;
  return {Transcription(grid_.method, h, true), Transcription(grid_.method, h, false)};
}

const VectorDerivatives& Collocation::tip_position(const VectorX& x) {
  return points_.positions(state(x, grid_.intervals, 0), {tip_}).front();
}

const VectorDerivatives& Collocation::tip_velocity(const VectorX& x) {
  return points_.velocity(state(x, grid_.intervals, 0), state(x, grid_.intervals, 1), tip_);
}

double Collocation::objective(const VectorX& x) {
  const double h = duration(x) / grid_.intervals;
  double effort = 0.0;
  for (int k = 0; k < grid_.intervals; ++k) {
    const VectorX before = torque(x, k), after = torque(x, k + 1);
    effort += rules_.linear_torque
                  ? (before.squaredNorm() + before.dot(after) + after.squaredNorm()) / 3.0
                  : after.squaredNorm();
  }
  const Objective& cost = task_.objective;
  double result = cost.effort * h * effort;
  if (cost.tip_speed > 0.0) result += cost.tip_speed * tip_velocity(x).value.squaredNorm();
  if (grid_.free()) result += cost.time * duration(x);
  return result;
}

void Collocation::gradient(const VectorX& x, VectorX& result) {
  const double h = duration(x) / grid_.intervals;
  const Objective& cost = task_.objective;
  result.setZero(variables_);
  for (int k = 0; k < grid_.intervals; ++k) {
    const VectorX before = torque(x, k), after = torque(x, k + 1);
    if (rules_.linear_torque) {
      result.segment(torque_at(k), inputs_) += cost.effort * h / 3.0 * (2.0 * before + after);
      result.segment(torque_at(k + 1), inputs_) += cost.effort * h / 3.0 * (before + 2.0 * after);
    } else {
      result.segment(torque_at(k + 1), inputs_) += 2.0 * cost.effort * h * after;
    }
    if (grid_.free()) {
      result[time_at()] +=
          cost.effort / grid_.intervals *
          (rules_.linear_torque
               ? (before.squaredNorm() + before.dot(after) + after.squaredNorm()) / 3.0
               : after.squaredNorm());
    }
  }
  if (cost.tip_speed > 0.0) {
    const auto& velocity = tip_velocity(x);
    result.segment(knot(grid_.intervals), 2 * n_) +=
        2.0 * cost.tip_speed * velocity.jacobian.transpose() * velocity.value;
  }
  if (grid_.free()) result[time_at()] += cost.time;
}

void Collocation::constraints(const VectorX& x, VectorX& result) {
  result.resize(constraints());
  const std::array<Transcription, 2> both = rules(x);
  const MatrixX& actuation = arm_->actuation();
  for (int k = 0; k < grid_.intervals; ++k) {
    const Transcription& rules = both[k > 0 ? 1 : 0];
    const MatrixX knots = pair(x, k);
    const VectorX before = torque(x, k), after = torque(x, k + 1);
    result.segment(row(k), n_) = knots * rules.defect.value.transpose();
    for (std::size_t s = 0; s < rules.stages.size(); ++s) {
      const Stage& stage = rules.stages[s];
      const MatrixX motion = knots * stage.state.value.transpose();
      result.segment(stage_row(k, static_cast<int>(s)), n_) =
          equations_.residual(motion.col(0), motion.col(1), motion.col(2)) -
          actuation * (stage.torque[0] * before + stage.torque[1] * after);
    }
    if (rate_limited_) {
      result.segment(rate_row(k), inputs_) = (after - before) * grid_.intervals / duration(x);
    }
    if (task_.obstacles.empty()) continue;
    const auto& where = points_.positions(state(x, k + 1, 0), backbone_);
    int at = clearance_row(k);
    for (const Obstacle& obstacle : task_.obstacles) {
      for (const VectorDerivatives& point : where) result[at++] = obstacle.distance(point.value);
    }
  }
  const Goal& goal = task_.goal;
  result[goal_row()] = SmoothLength(tip_position(x).value - goal.position, goal.tolerance).value;
  if (speed_limited_) {
    result[speed_row()] = SmoothLength(tip_velocity(x).value, goal.speed_tolerance).value;
  }
}

template <typename Emit>
void Collocation::each_jacobian_entry(const VectorX& x, const Emit& emit) {
  const std::array<Transcription, 2> both = rules(x);
  const MatrixX& actuation = arm_->actuation();
  const int blocks = rules_.blocks;
  const auto column = [&](int k, int block) {
    return block < blocks ? knot(k) + block * n_ : knot(k + 1) + (block - blocks) * n_;
  };
  const double share = 1.0 / grid_.intervals;  // dh/dt_f
  const auto torque_entries = [&](int first_row, int k, double weight) {
    if (weight == 0.0) return;
    for (int i = 0; i < n_; ++i) {
      for (int u = 0; u < inputs_; ++u) {
        if (actuation(i, u) != 0.0) {
          emit(first_row + i, torque_at(k) + u, -weight * actuation(i, u));
        }
      }
    }
  };
  for (int k = 0; k < grid_.intervals; ++k) {
    const Transcription& rules = both[k > 0 ? 1 : 0];
    const MatrixX knots = pair(x, k);
    for (int i = 0; i < n_; ++i) {
      for (int b = 0; b < 2 * blocks; ++b) {
        if (rules.defect.value(0, b) != 0.0) {
          emit(row(k) + i, column(k, b) + i, rules.defect.value(0, b));
        }
      }
      if (grid_.free()) {
        emit(row(k) + i, time_at(), share * knots.row(i).dot(rules.defect.slope.row(0)));
      }
    }
    for (std::size_t s = 0; s < rules.stages.size(); ++s) {
      const Stage& stage = rules.stages[s];
      const int first = stage_row(k, static_cast<int>(s));
      const MatrixX motion = knots * stage.state.value.transpose();
      const auto& linear = equations_.linearise(motion.col(0), motion.col(1), motion.col(2));
      const std::array<const MatrixX*, 3> by{&linear.by_position, &linear.by_rate,
                                             &linear.by_acceleration};
      for (int b = 0; b < 2 * blocks; ++b) {
        if (stage.state.value.col(b).isZero(0.0)) continue;
        MatrixX block = MatrixX::Zero(n_, n_);
        for (int a = 0; a < 3; ++a) {
          block += stage.state.value(a, b) * *by[static_cast<std::size_t>(a)];
        }
        for (int i = 0; i < n_; ++i) {
          for (int j = 0; j < n_; ++j) emit(first + i, column(k, b) + j, block(i, j));
        }
      }
      if (grid_.free()) {
        const MatrixX slope = share * knots * stage.state.slope.transpose();
        const VectorX total = *by[0] * slope.col(0) + *by[1] * slope.col(1) + *by[2] * slope.col(2);
        for (int i = 0; i < n_; ++i) emit(first + i, time_at(), total[i]);
      }
      torque_entries(first, k, stage.torque[0]);
      torque_entries(first, k + 1, stage.torque[1]);
    }
    if (rate_limited_) {
      const double per = 1.0 / (share * duration(x));
      for (int u = 0; u < inputs_; ++u) {
        emit(rate_row(k) + u, torque_at(k) + u, -per);
        emit(rate_row(k) + u, torque_at(k + 1) + u, per);
        if (grid_.free()) {
          emit(rate_row(k) + u, time_at(),
               -per / duration(x) * (x[torque_at(k + 1) + u] - x[torque_at(k) + u]));
        }
      }
    }
    if (task_.obstacles.empty()) continue;
    const auto& where = points_.positions(state(x, k + 1, 0), backbone_);
    int at = clearance_row(k);
    for (const Obstacle& obstacle : task_.obstacles) {
      for (const VectorDerivatives& point : where) {
        const VectorX slope = point.jacobian.transpose() * obstacle.gradient(point.value);
        for (int j = 0; j < n_; ++j) emit(at, knot(k + 1) + j, slope[j]);
        ++at;
      }
    }
  }
  const int last = knot(grid_.intervals);
  const Goal& goal = task_.goal;
  const auto& tip = tip_position(x);
  const VectorX distance =
      tip.jacobian.transpose() * SmoothLength(tip.value - goal.position, goal.tolerance).gradient;
  for (int j = 0; j < n_; ++j) emit(goal_row(), last + j, distance[j]);
  if (!speed_limited_) return;
  const auto& velocity = tip_velocity(x);
  const VectorX speed =
      velocity.jacobian.transpose() * SmoothLength(velocity.value, goal.speed_tolerance).gradient;
  for (int j = 0; j < 2 * n_; ++j) emit(speed_row(), last + j, speed[j]);
}

void Collocation::jacobian(const VectorX& x, double* values) {
  each_jacobian_entry(x, [&](int, int, double value) { *values++ = value; });
}

template <typename Emit>
void Collocation::effort_hessian(const VectorX& x, double factor, const Emit& emit) {
  const double effort = factor * task_.objective.effort, h = duration(x) / grid_.intervals;
  const double own = rules_.linear_torque ? 2.0 / 3.0 : 2.0;
  for (int k = 0; k < grid_.intervals; ++k) {
    for (int u = 0; u < inputs_; ++u) {
      const int before = torque_at(k) + u, after = torque_at(k + 1) + u;
      emit(after, after, effort * h * own);
      if (rules_.linear_torque) {
        emit(before, before, effort * h * own);
        emit(after, before, effort * h / 3.0);
      }
      if (!grid_.free()) continue;
      const double per = effort / grid_.intervals;
      if (rules_.linear_torque) {
        emit(time_at(), before, per / 3.0 * (2.0 * x[before] + x[after]));
        emit(time_at(), after, per / 3.0 * (x[before] + 2.0 * x[after]));
      } else {
        emit(time_at(), after, 2.0 * per * x[after]);
      }
    }
  }
}

template <typename Emit>
void Collocation::interval_hessian(const VectorX& x, int k, const VectorX& multipliers,
                                   const Emit& emit) {
  // In the interval's own variables: 2 blocks of n, and h.
  const Transcription rules(grid_.method, duration(x) / grid_.intervals, k == 0);
  const int blocks = 2 * rules.blocks, size = blocks * n_;
  const MatrixX knots = pair(x, k);
  const double share = 1.0 / grid_.intervals;
  MatrixX sum = MatrixX::Zero(size, size);
  VectorX cross = VectorX::Zero(size);
  double by_time = 0.0;
  for (std::size_t s = 0; s < rules.stages.size(); ++s) {
    const Weights& weights = rules.stages[s].state;
    const MatrixX motion = knots * weights.value.transpose();
    const VectorX weight = multipliers.segment(stage_row(k, static_cast<int>(s)), n_);
    const MatrixX& curvature =
        equations_.curvature(weight, motion.col(0), motion.col(1), motion.col(2));
    for (int a = 0; a < 3; ++a) {
      for (int c = 0; c < 3; ++c) {
        const MatrixX part = curvature.block(a * n_, c * n_, n_, n_);
        for (int i = 0; i < blocks; ++i) {
          for (int j = 0; j <= i; ++j) {
            const double scale = weights.value(a, i) * weights.value(c, j);
            if (scale != 0.0) sum.block(i * n_, j * n_, n_, n_) += scale * part;
          }
        }
      }
    }
    if (!grid_.free()) continue;
    // d/dh of the stage's motion is its slope: K slope, and the gradient by the weights' slopes.
    const MatrixX slope = knots * weights.slope.transpose();
    const MatrixX bend = knots * weights.bend.transpose();
    const VectorX slopes = slope.reshaped(), curved = curvature * slopes;
    const auto& linear = equations_.linearise(motion.col(0), motion.col(1), motion.col(2));
    MatrixX gradient(n_, 3);
    gradient << linear.by_position.transpose() * weight, linear.by_rate.transpose() * weight,
        linear.by_acceleration.transpose() * weight;
    for (int i = 0; i < blocks; ++i) {
      for (int a = 0; a < 3; ++a) {
        cross.segment(i * n_, n_) += weights.value(a, i) * curved.segment(a * n_, n_) +
                                     weights.slope(a, i) * gradient.col(a);
      }
    }
    by_time += slopes.dot(curved) + gradient.cwiseProduct(bend).sum();
  }
  const auto column = [&](int local) {
    const int half = size / 2;
    return local < half ? knot(k) + local : knot(k + 1) + local - half;
  };
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j <= i; ++j) emit(column(i), column(j), sum(i, j));
  }
  if (grid_.free()) {
    const VectorX weight = multipliers.segment(row(k), n_);
    for (int i = 0; i < blocks; ++i) {
      cross.segment(i * n_, n_) += rules.defect.slope(0, i) * weight;
    }
    by_time += weight.dot(knots * rules.defect.bend.row(0).transpose());
    for (int i = 0; i < size; ++i) emit(time_at(), column(i), share * cross[i]);
    emit(time_at(), time_at(), share * share * by_time);
  }
  if (rate_limited_ && grid_.free()) {
    const double t = duration(x), per = grid_.intervals / (t * t);
    for (int u = 0; u < inputs_; ++u) {
      const double weight = multipliers[rate_row(k) + u];
      const int before = torque_at(k) + u, after = torque_at(k + 1) + u;
      emit(time_at(), before, weight * per);
      emit(time_at(), after, -weight * per);
      emit(time_at(), time_at(), 2.0 * weight * per / t * (x[after] - x[before]));
    }
  }
  if (task_.obstacles.empty()) return;
  const auto& where = points_.positions(state(x, k + 1, 0), backbone_);
  MatrixX clearances = MatrixX::Zero(n_, n_);
  int at = clearance_row(k);
  for (const Obstacle& obstacle : task_.obstacles) {
    for (const VectorDerivatives& point : where) {
      clearances += multipliers[at++] *
                    composed(obstacle.gradient(point.value), obstacle.hessian(point.value), point);
    }
  }
  for (int i = 0; i < n_; ++i) {
    for (int j = 0; j <= i; ++j) emit(knot(k + 1) + i, knot(k + 1) + j, clearances(i, j));
  }
}

template <typename Emit>
void Collocation::terminal_hessian(const VectorX& x, double factor, const VectorX& multipliers,
                                   const Emit& emit) {
  const Goal& goal = task_.goal;
  MatrixX sum = MatrixX::Zero(2 * n_, 2 * n_);
  const auto& tip = tip_position(x);
  const SmoothLength distance(tip.value - goal.position, goal.tolerance);
  sum.topLeftCorner(n_, n_) =
      multipliers[goal_row()] * composed(distance.gradient, distance.hessian, tip);
  if (speed_limited_ || task_.objective.tip_speed > 0.0) {
    const auto& velocity = tip_velocity(x);
    if (speed_limited_) {
      const SmoothLength speed(velocity.value, goal.speed_tolerance);
      sum += multipliers[speed_row()] * composed(speed.gradient, speed.hessian, velocity);
    }
    sum += factor * task_.objective.tip_speed *
           composed(2.0 * velocity.value, 2.0 * Matrix3::Identity(), velocity);
  }
  const int last = knot(grid_.intervals);
  for (int i = 0; i < 2 * n_; ++i) {
    for (int j = 0; j <= i; ++j) emit(last + i, last + j, sum(i, j));
  }
}

template <typename Emit>
void Collocation::each_hessian_entry(const VectorX& x, double factor, const VectorX& multipliers,
                                     const Emit& emit) {
  effort_hessian(x, factor, emit);
  for (int k = 0; k < grid_.intervals; ++k) interval_hessian(x, k, multipliers, emit);
  terminal_hessian(x, factor, multipliers, emit);
}

void Collocation::hessian(const VectorX& x, double factor, const VectorX& multipliers,
                          double* values) {
  each_hessian_entry(x, factor, multipliers, [&](int, int, double value) { *values++ = value; });
}

VectorX Collocation::pack(const Knots& knots) const {
  VectorX x(variables_);
  for (int k = 0; k <= grid_.intervals; ++k) {
    x.segment(knot(k), n_) = knots.position.row(k);
    x.segment(knot(k) + n_, n_) = knots.rate.row(k);
    if (rules_.blocks == 3) x.segment(knot(k) + 2 * n_, n_) = knots.acceleration.row(k);
    x.segment(torque_at(k), inputs_) = knots.torque.row(k);
  }
  if (grid_.free()) x[time_at()] = knots.times[knots.times.size() - 1];
  return x;
}

Knots Collocation::unpack(const VectorX& x) const {
  const int count = grid_.intervals + 1;
  Knots knots{VectorX::LinSpaced(count, 0.0, duration(x)), MatrixX(count, n_), MatrixX(count, n_),
              MatrixX::Zero(count, n_), MatrixX(count, inputs_)};
  for (int k = 0; k < count; ++k) {
    knots.position.row(k) = state(x, k, 0);
    knots.rate.row(k) = state(x, k, 1);
    if (rules_.blocks == 3) {
      knots.acceleration.row(k) = state(x, k, 2);
    } else if (k > 0) {
      knots.acceleration.row(k) = (knots.rate.row(k) - knots.rate.row(k - 1)) / knots.times[1];
    }
    knots.torque.row(k) = torque(x, k);
  }
  return knots;
}

}  // namespace sinew::plan
