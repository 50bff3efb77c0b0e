#include "sinew/control/rate_program.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/qp/elastic.hpp"

namespace sinew::control {

namespace {

// Weights of changes of efforts, and of efforts: too small to keep effectors from their targets,
// but large enough for redundant actuators to share evenly and to relax in time.
constexpr double kChange = 1e-5;
constexpr double kRelaxation = 1e-7;
// Makes the program definite if actuators have no compliance.
constexpr double kDefinite = 1e-9;
constexpr double kTiny = std::numeric_limits<double>::min();

// Scales of efforts, 1/sqrt of their own compliance, so that scaled efforts have the unit sqrt(J).
VectorX scales(const MatrixX& w_aa) {
  VectorX scale = VectorX::Ones(w_aa.rows());
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    if (w_aa(k, k) > 0.0) scale[k] = 1.0 / std::sqrt(w_aa(k, k));
  }
  return scale;
}

}  // namespace

RateChoice choose_change(const MatrixX& w_ea, const MatrixX& w_aa, const VectorX& wanted,
                         const VectorX& weights, const RateLimits& limits) {
  const Eigen::Index count = w_aa.rows();
  const VectorX scale = scales(w_aa);
  const MatrixX moves = w_ea * scale.asDiagonal();
  const MatrixX energy =
      scale.asDiagonal() * (0.5 * (w_aa + w_aa.transpose())) * scale.asDiagonal();
  const MatrixX reached = moves.transpose() * weights.asDiagonal() * moves;
  const double size = std::max(reached.trace() / static_cast<double>(count), kTiny);
  auto program = qp::QuadraticProgram::sized(static_cast<int>(count), static_cast<int>(count));
  program.hessian = reached + size * (kChange + kRelaxation) * energy +
                    size * kDefinite * MatrixX::Identity(count, count);
  program.gradient = size * kRelaxation * energy * limits.effort.cwiseQuotient(scale) -
                     moves.transpose() * weights.cwiseProduct(wanted);
  program.lower = (limits.effort_min - limits.effort).cwiseQuotient(scale);
  program.upper = (limits.effort_max - limits.effort).cwiseQuotient(scale);
  program.rows = w_aa * scale.asDiagonal();
  program.row_lower = limits.motion_min - limits.motion;
  program.row_upper = limits.motion_max - limits.motion;
  qp::ElasticSolver solver(static_cast<int>(count), static_cast<int>(count));
  const qp::ElasticResult& found = solver.solve(program, limits.motion_scale);
  const bool active = (found.qp.bound_multiplier.array() != 0.0).any() ||
                      (found.qp.row_multiplier.array() != 0.0).any();
  return {scale.cwiseProduct(found.qp.x), active, found.relaxed > 0};
}

}  // namespace sinew::control
