// Jacobian and Hessian of the program. Each entry is visited once, to note its position or its
// value.
#include <array>

#include "sinew/plan/collocation.hpp"

namespace sinew::plan {

namespace {

/// Second-order chain rule, J^T H J + sum g_i H_i.
MatrixX composed(const Vector3& gradient, const Matrix3& hessian, const VectorDerivatives& inner) {
  MatrixX result = inner.jacobian.transpose() * hessian * inner.jacobian;
  for (std::size_t i = 0; i < 3; ++i) {
    result += gradient[static_cast<Eigen::Index>(i)] * inner.hessian[i];
  }
  return result;
}

/// Adds scale w w^T on the unknowns of a linear form, in the lower triangle.
template <typename Emit>
void emit_square(const LinearForm& form, double scale, const Emit& emit) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(form.count); ++i) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(form.count); ++j) {
      const double weight = form.weight[i] * form.weight[j];
      if (weight == 0.0 || form.at[i] < form.at[j]) continue;
      emit(form.at[i], form.at[j], scale * weight);
    }
  }
}

}  // namespace

template <typename Emit>
void Collocation::each_jacobian_entry(const VectorX& x, const Emit& emit) {
  const std::vector<Transcription>& all = rules(x);
  const MatrixX& actuation = arm_->actuation();
  const int blocks = blocks_;
  const auto column = [&](int k, int block) {
    return block < blocks ? knot(k) + block * n_ : knot(k + 1) + (block - blocks) * n_;
  };
  const auto torque_entries = [&](int first_row, int k, double when) {
    for (int u = 0; u < inputs_; ++u) {
      const LinearForm form = input(k, when, u);
      const double slope = response(x, form, u).slope;
      for (std::size_t m = 0; m < static_cast<std::size_t>(form.count); ++m) {
        if (form.weight[m] == 0.0) continue;
        for (int i = 0; i < n_; ++i) {
          if (actuation(i, u) == 0.0) continue;
          emit(first_row + i, form.at[m], -form.weight[m] * slope * actuation(i, u));
        }
      }
    }
  };
  for (int k = 0; k < grid_.intervals; ++k) {
    const Transcription& rules = all[static_cast<std::size_t>(k)];
    const double fraction = grid_.fractions[k];  // dh/dt_f
    const MatrixX knots = pair(x, k);
    for (int i = 0; i < n_ * defects_; ++i) {
      for (int b = 0; b < 2 * blocks; ++b) {
        if (rules.defect.value(0, b) != 0.0) {
          emit(row(k) + i, column(k, b) + i, rules.defect.value(0, b));
        }
      }
      if (grid_.free()) {
        emit(row(k) + i, time_at(), fraction * knots.row(i).dot(rules.defect.slope.row(0)));
      }
    }
    for (std::size_t s = 0; s < rules.stages.size(); ++s) {
      const CollocationStage& stage = rules.stages[s];
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
        const MatrixX slope = fraction * knots * stage.state.slope.transpose();
        const VectorX total = *by[0] * slope.col(0) + *by[1] * slope.col(1) + *by[2] * slope.col(2);
        for (int i = 0; i < n_; ++i) emit(first + i, time_at(), total[i]);
      }
      torque_entries(first, k, stage.time);
    }
    if (rate_limited_) {
      const double per = 1.0 / (fraction * duration(x));
      for (int u = 0; u < inputs_; ++u) {
        double change = 0.0;
        for (const double when : {0.0, 1.0}) {
          const LinearForm form = input(k, when, u);
          const Response of = response(x, form, u);
          const double sign = when > 0.0 ? 1.0 : -1.0;
          change += sign * of.torque;
          for (std::size_t m = 0; m < static_cast<std::size_t>(form.count); ++m) {
            if (form.weight[m] == 0.0) continue;
            emit(rate_row(k) + u, form.at[m], sign * per * of.slope * form.weight[m]);
          }
        }
        if (grid_.free()) emit(rate_row(k) + u, time_at(), -per / duration(x) * change);
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
  const auto& tip = tip_position(x);
  const VectorX nearer = tip.jacobian.transpose() * distance(tip.value).gradient;
  for (int j = 0; j < n_; ++j) emit(goal_row(), last + j, nearer[j]);
  if (drive_) {
    for (const auto& [row, at, value] : drive_->jacobian()) emit(row, at, value);
  }
  if (!speed_limited_) return;
  const auto& velocity = tip_velocity(x);
  const VectorX slower = velocity.jacobian.transpose() * speed(velocity.value).gradient;
  for (int j = 0; j < 2 * n_; ++j) emit(speed_row(), last + j, slower[j]);
}

void Collocation::jacobian(const VectorX& x, double* values) {
  each_jacobian_entry(x, [&](int, int, double value) { *values++ = value; });
}

template <typename Emit>
void Collocation::effort_hessian(const VectorX& x, double factor, const Emit& emit) {
  const double effort = 2.0 * factor * task_.objective.effort;
  each_effort_point(x, [&](int k, double fraction, double weight) {
    for (int u = 0; u < inputs_; ++u) {
      const LinearForm form = input(k, fraction, u);
      const Response of = response(x, form, u);
      const double second = of.slope * of.slope + of.torque * of.curvature;
      emit_square(form, effort * weight * duration(x) * second, emit);
      if (!grid_.free()) continue;
      for (std::size_t m = 0; m < static_cast<std::size_t>(form.count); ++m) {
        if (form.weight[m] == 0.0) continue;
        emit(time_at(), form.at[m], effort * weight * of.torque * of.slope * form.weight[m]);
      }
    }
  });
}

template <typename Emit>
void Collocation::torque_hessian(const VectorX& x, int k, const Transcription& rules,
                                 const VectorX& multipliers, const Emit& emit) {
  const auto add = [&](double fraction, int u, double multiplier) {
    const LinearForm form = input(k, fraction, u);
    emit_square(form, multiplier * response(x, form, u).curvature, emit);
  };
  for (std::size_t s = 0; s < rules.stages.size(); ++s) {
    const VectorX weight =
        -arm_->actuation().transpose() * multipliers.segment(stage_row(k, static_cast<int>(s)), n_);
    for (int u = 0; u < inputs_; ++u) add(rules.stages[s].time, u, weight[u]);
  }
  if (!rate_limited_) return;
  const double per = 1.0 / (grid_.fractions[k] * duration(x));
  for (int u = 0; u < inputs_; ++u) {
    add(0.0, u, -per * multipliers[rate_row(k) + u]);
    add(1.0, u, per * multipliers[rate_row(k) + u]);
  }
}

template <typename Emit>
void Collocation::interval_hessian(const VectorX& x, int k, const VectorX& multipliers,
                                   const Emit& emit) {
  // The local variables of an interval are 2 blocks of n, and h.
  const Transcription& rules = this->rules(x)[static_cast<std::size_t>(k)];
  const int blocks = 2 * blocks_, size = blocks * n_;
  const MatrixX knots = pair(x, k);
  const double fraction = grid_.fractions[k];
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
    // The derivative of a stage's motion with respect to h is its slope. It contributes K slope,
    // and the gradient with the slopes of the weights.
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
  // The stages of Radau do not depend on the acceleration of the first knot.
  const auto takes_part = [&](int local) { return blocks_ < 3 || local / n_ != 2; };
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j <= i && takes_part(i); ++j) {
      if (takes_part(j)) emit(column(i), column(j), sum(i, j));
    }
  }
  if (grid_.free()) {
    if (defects_ > 0) {
      const VectorX weight = multipliers.segment(row(k), n_);
      for (int i = 0; i < blocks; ++i) {
        cross.segment(i * n_, n_) += rules.defect.slope(0, i) * weight;
      }
      by_time += weight.dot(knots * rules.defect.bend.row(0).transpose());
    }
    for (int i = 0; i < size; ++i) {
      if (takes_part(i)) emit(time_at(), column(i), fraction * cross[i]);
    }
    emit(time_at(), time_at(), fraction * fraction * by_time);
  }
  if (drive_) torque_hessian(x, k, rules, multipliers, emit);
  if (rate_limited_ && grid_.free()) {
    const double t = duration(x), per = 1.0 / (fraction * t * t);
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
  MatrixX sum = MatrixX::Zero(2 * n_, 2 * n_);
  const auto& tip = tip_position(x);
  const SmoothLength from_goal = distance(tip.value);
  sum.topLeftCorner(n_, n_) =
      multipliers[goal_row()] * composed(from_goal.gradient, from_goal.hessian, tip);
  if (speed_limited_ || task_.objective.tip_speed > 0.0) {
    const auto& velocity = tip_velocity(x);
    if (speed_limited_) {
      const SmoothLength slower = speed(velocity.value);
      sum += multipliers[speed_row()] * composed(slower.gradient, slower.hessian, velocity);
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
  if (!drive_) return;
  for (const auto& [row, at, value] : drive_->cost_hessian()) emit(row, at, factor * value);
}

void Collocation::hessian(const VectorX& x, double factor, const VectorX& multipliers,
                          double* values) {
  each_hessian_entry(x, factor, multipliers, [&](int, int, double value) { *values++ = value; });
}

void Collocation::note_patterns() {
  const VectorX x = variable_scale_;
  each_jacobian_entry(x, [&](int row, int column, double) {
    jacobian_pattern_.push_back({row, column});
  });
  each_hessian_entry(x, 1.0, VectorX::Ones(constraints()), [&](int row, int column, double) {
    hessian_pattern_.push_back({row, column});
  });
}

}  // namespace sinew::plan
