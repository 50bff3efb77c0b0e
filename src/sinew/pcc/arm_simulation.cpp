#include "sinew/pcc/arm_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"

namespace sinew::pcc {

namespace {

constexpr double kRounding = 1e-15;

}  // namespace

ArmSimulation::ArmSimulation(std::shared_ptr<const Arm> arm, const ArmStepSettings& settings)
    : equations_(std::move(arm)), settings_(settings) {
  const Eigen::Index n = equations_.arm().coordinates();
  const Location place{.item = equations_.arm().settings().name};
  if (!(settings.time_step > 0.0) || !std::isfinite(settings.time_step)) {
    throw Error(ErrorKind::out_of_range, place,
                fmt::format("the time step is {:g} s", settings.time_step), "give more than zero");
  }
  if (!(settings.spectral_radius >= 0.0 && settings.spectral_radius <= 1.0)) {
    throw Error(ErrorKind::out_of_range, place,
                fmt::format("the spectral radius is {:g}", settings.spectral_radius),
                "give 0 (damps most) to 1 (not at all)");
  }
  if (settings.integrator == mechanics::Integrator::quasi_static) {
    throw Error(ErrorKind::unknown_choice, place, "an arm by itself moves dynamically",
                "choose backward-euler, bdf2 or generalized-alpha, or ask for its equilibrium");
  }
  motion_ = start_ = new_rate_ = acceleration_ = residual_ = drive_ = VectorX::Zero(n);
  last_.matrix = MatrixX::Zero(n, n);
  new_acceleration_ = correction_ = VectorX::Zero(n);
  decomposed_ = linalg::LuFactor(n);
  set_state(VectorX::Zero(n), VectorX::Zero(n));
}

void ArmSimulation::set_state(const VectorX& q, const VectorX& rate, double time) {
  q_ = q;
  rate_ = rate;
  first_.setZero(q.size());
  second_.setZero(q.size());
  time_ = time;
  step_before_ = 0.0;
}

void ArmSimulation::step(const VectorX& torque) {
  last_.weights = mechanics::step_weights(settings_.integrator, settings_.time_step, step_before_,
                                          settings_.spectral_radius);
  const mechanics::StepWeights& weights = last_.weights;
  const auto combine = [&](const mechanics::Combination& c, VectorX& result) {
    result = c.motion * motion_ + c.velocity * rate_ + c.first * first_ + c.second * second_;
  };
  drive_.noalias() = arm().actuation() * torque;
  start_ = q_;
  motion_ = settings_.time_step * rate_;
  const Location place{.item = arm().settings().name};
  for (iterations_ = 0;;) {
    q_ = start_ + motion_;
    combine(weights.velocity, new_rate_);
    combine(weights.acceleration, new_acceleration_);
    const auto& linear = equations_.linearise(q_, new_rate_, new_acceleration_);
    last_.linear = &linear;
    residual_ = linear.residual - drive_;
    last_.matrix = linear.by_position + weights.velocity.motion * linear.by_rate +
                   weights.acceleration.motion * linear.by_acceleration;
    // The largest torque, to which the tolerance is relative.
    const double scale = drive_.cwiseAbs().maxCoeff() +
                         (arm().stiffness().cwiseProduct(q_)).cwiseAbs().maxCoeff() +
                         (linear.by_acceleration * new_acceleration_).cwiseAbs().maxCoeff() +
                         1e-6 * arm().stiffness().maxCoeff();
    const double left = residual_.cwiseAbs().maxCoeff();
    const bool first = iterations_ == 0;
    // Torques caused by the rounding of positions through the matrix, which contains H / h^2.
    const double rounding =
        kRounding *
        (last_.matrix.cwiseAbs() * (q_.cwiseAbs() + VectorX::Constant(q_.size(), 1e-3))).maxCoeff();
    if (!first && left <= settings_.tolerance * scale + rounding) break;
    if (!std::isfinite(left) || iterations_ == settings_.max_iterations) {
      q_ = start_;
      throw Error(std::isfinite(left) ? ErrorKind::not_converged : ErrorKind::diverged, place,
                  fmt::format("Newton's method left {:.3g} N m after {} iterations at {:.6g} s",
                              left, iterations_, time_ + settings_.time_step),
                  "make the time step smaller, or the damping larger");
    }
    decomposed_.compute(last_.matrix);
    decomposed_.solve(residual_, correction_);
    motion_ -= correction_;
    ++iterations_;
  }
  // The new history follows from the values at the start of the step.
  combine(weights.first, acceleration_);
  combine(weights.second, residual_);
  first_.swap(acceleration_);
  second_.swap(residual_);
  rate_.swap(new_rate_);
  step_before_ = settings_.time_step;
  time_ += settings_.time_step;
}

ArmEquilibrium find_equilibrium(ArmEquations& equations, const VectorX& torque,
                                const VectorX& start) {
  constexpr int kMaxIterations = 200;
  const Arm& arm = equations.arm();
  const Eigen::Index n = arm.coordinates();
  const VectorX drive = arm.actuation() * torque, still = VectorX::Zero(n);
  const auto potential = [&](const VectorX& q) {
    const auto energy = equations.energy(q, still);
    return energy.strain + energy.gravity - drive.dot(q);
  };
  ArmEquilibrium result{start, false, 0};
  VectorX& q = result.position;
  const double unit = arm.stiffness().maxCoeff();
  for (; result.iterations < kMaxIterations; ++result.iterations) {
    const auto& linear = equations.linearise(q, still, still);
    const VectorX gradient = linear.residual - drive;
    const MatrixX hessian = 0.5 * (linear.by_position + linear.by_position.transpose());
    const double lowest = linalg::symmetric_eigenvalues(hessian)[0];
    const double scale = drive.cwiseAbs().maxCoeff() +
                         arm.stiffness().cwiseProduct(q).cwiseAbs().maxCoeff() + 1e-3 * unit;
    if (gradient.cwiseAbs().maxCoeff() <= 1e-11 * scale) {
      result.stable = lowest > 0.0;
      return result;
    }
    const double shift = lowest > 1e-6 * unit ? 0.0 : 1e-3 * unit - lowest;
    VectorX move = -linalg::solve_symmetric(hessian + shift * MatrixX::Identity(n, n), gradient);
    // A quadratic model is trusted up to one radian per coordinate.
    move *= std::min(1.0, 1.0 / move.cwiseAbs().maxCoeff());
    const double before = potential(q), slope = gradient.dot(move);
    double length = 1.0;
    // Near the solution, rounding of the potential hides the descent. The full step is then
    // accepted.
    const double rounding = 1e-13 * (std::abs(before) + scale);
    while (length > 1e-6 &&
           potential(q + length * move) > before + 1e-4 * length * slope + rounding) {
      length *= 0.5;
    }
    q += length * move;
  }
  throw Error(ErrorKind::not_converged, {.item = arm.settings().name},
              fmt::format("no equilibrium after {} iterations", kMaxIterations),
              "start nearer to it, or give the arm some stiffness");
}

}  // namespace sinew::pcc
