#include "sinew/plan/reach.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/pcc/arm_simulation.hpp"
#include "sinew/plan/point_derivatives.hpp"
#include "sinew/plan/uniform.hpp"

namespace sinew::plan {

namespace {

/// The program min |tip - goal|^2 over (q, tau) in equilibrium.
class NearestProgram final : public NonlinearProgram {
 public:
  NearestProgram(const std::shared_ptr<const pcc::Arm>& arm, const ArmLimits& limits,
                 const Vector3& goal)
      : arm_(arm),
        equations_(arm),
        points_(arm),
        goal_(goal),
        n_(arm->coordinates()),
        inputs_(arm->inputs()),
        still_(VectorX::Zero(n_)),
        tip_{arm->segments() - 1} {
    variable_bounds_ = {VectorX(n_ + inputs_), VectorX(n_ + inputs_)};
    variable_bounds_.lower << limits.angle_lower, limits.torque_lower;
    variable_bounds_.upper << limits.angle_upper, limits.torque_upper;
    constraint_bounds_ = {VectorX::Zero(n_), VectorX::Zero(n_)};
    const double torque = std::max(limits.torque_upper.cwiseAbs().maxCoeff(), 1e-6);
    variable_scale_ = VectorX::Ones(n_ + inputs_);
    variable_scale_.tail(inputs_).setConstant(torque);
    constraint_scale_ = VectorX::Constant(n_, torque);
    objective_scale_ = std::pow(0.1 * arm_->length(), 2);
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j < n_; ++j) jacobian_pattern_.push_back({i, j});
      for (int u = 0; u < inputs_; ++u) jacobian_pattern_.push_back({i, n_ + u});
      for (int j = 0; j <= i; ++j) hessian_pattern_.push_back({i, j});
    }
  }

  double objective(const VectorX& x) override { return (tip(x).value - goal_).squaredNorm(); }
  void gradient(const VectorX& x, VectorX& result) override {
    const auto& at = tip(x);
    result.setZero(n_ + inputs_);
    result.head(n_) = 2.0 * at.jacobian.transpose() * (at.value - goal_);
  }
  void constraints(const VectorX& x, VectorX& result) override {
    result = equations_.residual(x.head(n_), still_, still_) - arm_->actuation() * x.tail(inputs_);
  }
  void jacobian(const VectorX& x, double* values) override {
    const MatrixX& stiffness = equations_.linearise(x.head(n_), still_, still_).by_position;
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j < n_; ++j) *values++ = stiffness(i, j);
      for (int u = 0; u < inputs_; ++u) *values++ = -arm_->actuation()(i, u);
    }
  }
  void hessian(const VectorX& x, double factor, const VectorX& multipliers,
               double* values) override {
    const MatrixX& curvature = equations_.curvature(multipliers, x.head(n_), still_, still_);
    const auto& at = tip(x);
    MatrixX sum = curvature.topLeftCorner(n_, n_);
    sum += 2.0 * factor * at.jacobian.transpose() * at.jacobian;
    const Vector3 error = at.value - goal_;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += 2.0 * factor * error[static_cast<Eigen::Index>(k)] * at.hessian[k];
    }
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j <= i; ++j) *values++ = sum(i, j);
    }
  }

 private:
  const VectorDerivatives& tip(const VectorX& x) {
    return points_.positions(x.head(n_), {tip_}).front();
  }

  std::shared_ptr<const pcc::Arm> arm_;
  pcc::ArmEquations equations_;
  PointDerivatives points_;
  Vector3 goal_;
  int n_, inputs_;
  VectorX still_;
  pcc::ArmPoint tip_;
};

}  // namespace

ArmLimits completed_limits(const pcc::Arm& arm, const ArmLimits& limits) {
  PlanTask task;
  task.goal.position = arm.settings().base;
  task.limits = limits;
  // Only limits are checked here, so the initial state is chosen within them.
  const auto inside = [](const VectorX& lower, const VectorX& upper, Eigen::Index size) {
    VectorX result = VectorX::Zero(size);
    if (lower.size() == size) result = result.cwiseMax(lower);
    if (upper.size() == size) result = result.cwiseMin(upper);
    return result;
  };
  task.start.position = inside(limits.angle_lower, limits.angle_upper, arm.coordinates());
  task.start.torque = inside(limits.torque_lower, limits.torque_upper, arm.inputs());
  ArmLimits result = completed(arm, task).limits;
  for (Eigen::Index u = 0; u < arm.inputs(); ++u) {
    if (result.torque_lower[u] <= -kNoBound || result.torque_upper[u] >= kNoBound) {
      throw Error(ErrorKind::out_of_range, {.item = fmt::format("limits.torque[{}]", u)},
                  "it has no limit", "give a lower and an upper one in N m");
    }
  }
  return result;
}

ReachMap sample_reach(const std::shared_ptr<const pcc::Arm>& arm, const ArmLimits& given,
                      int samples, std::uint64_t seed) {
  if (samples < 1) {
    throw Error(ErrorKind::out_of_range, {.item = "samples"}, fmt::format("{}", samples),
                "give 1 or more");
  }
  const ArmLimits limits = completed_limits(*arm, given);
  pcc::ArmEquations equations(arm);
  Uniform random(seed);
  const Eigen::Index n = arm->coordinates(), inputs = arm->inputs();
  ReachMap result{MatrixX(2 * samples, n), MatrixX(2 * samples, inputs), Points(2 * samples, 3)};
  Eigen::Index found = 0;
  for (int s = 0; s < samples; ++s) {
    VectorX torque = random.vector(limits.torque_lower, limits.torque_upper);
    if (s % 2 == 1) {
      for (Eigen::Index u = 0; u < inputs; ++u) {
        torque[u] = random(-1.0, 1.0) < 0.0 ? limits.torque_lower[u] : limits.torque_upper[u];
      }
    }
    for (const bool straight : {true, false}) {
      const VectorX start = straight ? VectorX::Zero(n)
                                     : random.vector(VectorX::Constant(n, -std::numbers::pi),
                                                     VectorX::Constant(n, std::numbers::pi));
      try {
        const auto rest = pcc::find_equilibrium(equations, torque, start);
        if (!rest.stable || (rest.position.array() < limits.angle_lower.array()).any() ||
            (rest.position.array() > limits.angle_upper.array()).any()) {
          continue;
        }
        result.position.row(found) = rest.position;
        result.torque.row(found) = torque;
        const Points ends = equations.endpoints(rest.position);
        result.tip.row(found++) = ends.row(ends.rows() - 1);
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::not_converged) throw;
      }
    }
  }
  result.position.conservativeResize(found, n);
  result.torque.conservativeResize(found, inputs);
  result.tip.conservativeResize(found, 3);
  return result;
}

NearestReach nearest_reach(const std::shared_ptr<const pcc::Arm>& arm, const ArmLimits& given,
                           const Vector3& goal, int starts, std::uint64_t seed) {
  const ArmLimits limits = completed_limits(*arm, given);
  NearestProgram program(arm, limits, goal);
  pcc::ArmEquations equations(arm);
  Uniform random(seed);
  const Eigen::Index n = arm->coordinates();
  const VectorX still = VectorX::Zero(n);
  NearestReach best;
  for (int s = 0; s < starts; ++s) {
    const VectorX wide = VectorX::Constant(n, std::numbers::pi / 2.0);
    VectorX start(n + arm->inputs());
    start << random.vector(limits.angle_lower.cwiseMax(-wide), limits.angle_upper.cwiseMin(wide)),
        random.vector(limits.torque_lower, limits.torque_upper);
    const ProgramResult found = solve(program, {start, {}, {}, {}});
    if (found.status != Status::solved && found.status != Status::acceptable) continue;
    ++best.solved;
    const VectorX q = found.point.x.head(n);
    const Points ends = equations.endpoints(q);
    const Vector3 tip = ends.row(ends.rows() - 1);
    const double distance = (tip - goal).norm();
    if (best.found && distance >= best.distance) continue;
    const MatrixX& stiffness = equations.linearise(q, still, still).by_position;
    const double lowest =
        linalg::symmetric_eigenvalues(0.5 * (stiffness + stiffness.transpose()))[0];
    best = {true, lowest > 0.0, distance, tip, q, found.point.x.tail(arm->inputs()), best.solved};
  }
  return best;
}

}  // namespace sinew::plan
