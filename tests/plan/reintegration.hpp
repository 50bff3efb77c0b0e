// Integrates the motion of planned torques with an independent integrator: extrapolated linearly
// implicit Euler steps with error control (Deuflhard 1985; Hairer & Wanner, Solving Ordinary
// Differential Equations II, 1996, IV.9) for q'' = H^-1 (B tau - ...).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "sinew/plan/planner.hpp"

namespace sinew::plan::testing {

class ExtrapolatedEuler {
 public:
  ExtrapolatedEuler(const std::shared_ptr<const pcc::Arm>& arm, const Plan& plan)
      : equations_(arm), plan_(plan), n_(arm->coordinates()) {}

  /// Advances the state (2n,) between two times. The torque must have no kink between them.
  VectorX advance(VectorX y, double from, double to) {
    double h = std::min(next_, to - from);
    while (from < to) {
      h = std::min(h, to - from);
      std::vector<VectorX> row{euler(y, from, h, 1)};
      double error = 0.0;
      for (int j = 2; j <= kOrder; ++j) {
        std::vector<VectorX> next{euler(y, from, h, j)};
        for (int k = 1; k < j; ++k) {
          const auto at = static_cast<std::size_t>(k - 1);
          const double ratio = static_cast<double>(j) / (j - k) - 1.0;
          next.push_back(next[at] + (next[at] - row[at]) / ratio);
        }
        const VectorX difference = next.back() - next[next.size() - 2];
        error = (difference.array() / (1e-8 * y.array().abs() + 1e-8)).abs().maxCoeff();
        row = std::move(next);
      }
      if (error <= 1.0 || h < 1e-12) {
        from = to - from <= h ? to : from + h;
        y = row.back();
      }
      h *= std::clamp(0.8 * std::pow(std::max(error, 1e-8), -1.0 / kOrder), 0.2, 4.0);
      next_ = h;
    }
    return y;
  }

 private:
  static constexpr int kOrder = 6;

  VectorX euler(VectorX y, double from, double h, int steps) {
    const double step = h / steps;
    const auto& at = equations_.forward_derivatives(y.head(n_), y.tail(n_), torque(from + 1e-9));
    MatrixX matrix = MatrixX::Identity(2 * n_, 2 * n_);
    matrix.topRightCorner(n_, n_) -= step * MatrixX::Identity(n_, n_);
    matrix.bottomLeftCorner(n_, n_) -= step * at.by_position;
    matrix.bottomRightCorner(n_, n_) -= step * at.by_rate;
    const Eigen::PartialPivLU<MatrixX> solver(matrix);
    for (int i = 1; i <= steps; ++i) {
      VectorX slope(2 * n_);
      slope << y.tail(n_), equations_.acceleration(y.head(n_), y.tail(n_), torque(from + i * step));
      y += solver.solve(step * slope);
    }
    return y;
  }
  VectorX torque(double time) const { return plan_.torque(time); }

  pcc::ArmEquations equations_;
  const Plan& plan_;
  Eigen::Index n_;
  double next_ = 1e-4;
};

struct TipEnd {
  Vector3 position, velocity;
};

/// Final position and velocity of the tip under the torques of a plan.
inline TipEnd reintegrated(const std::shared_ptr<const pcc::Arm>& arm, const PlanTask& asked,
                           const Plan& plan) {
  const PlanTask task = completed(*arm, asked);
  const Eigen::Index n = arm->coordinates();
  VectorX y(2 * n);
  y << task.start.position, task.start.rate;
  ExtrapolatedEuler motion(arm, plan);
  for (Eigen::Index k = 1; k < plan.knots.times.size(); ++k) {
    y = motion.advance(y, plan.knots.times[k - 1], plan.knots.times[k]);
  }
  pcc::ArmEquations equations(arm);
  const auto tip = equations.point({arm->segments() - 1}, y.head(n), y.tail(n));
  return {tip.position, tip.jacobian * y.tail(n)};
}

}  // namespace sinew::plan::testing
