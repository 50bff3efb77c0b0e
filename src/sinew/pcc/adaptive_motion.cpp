#include "sinew/pcc/adaptive_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::pcc {

namespace {

// Hairer & Wanner 1996, table 6.5. The last row is the result.
constexpr double kDiagonal = 0.25;
constexpr std::array<double, 5> kTime{1.0 / 4, 3.0 / 4, 11.0 / 20, 1.0 / 2, 1.0};
constexpr std::array<std::array<double, 5>, 5> kWeight{{
    {1.0 / 4, 0.0, 0.0, 0.0, 0.0},
    {1.0 / 2, 1.0 / 4, 0.0, 0.0, 0.0},
    {17.0 / 50, -1.0 / 25, 1.0 / 4, 0.0, 0.0},
    {371.0 / 1360, -137.0 / 2720, 15.0 / 544, 1.0 / 4, 0.0},
    {25.0 / 24, -49.0 / 48, 125.0 / 16, -85.0 / 12, 1.0 / 4},
}};
// Weights of the result minus those of the embedded formula.
constexpr std::array<double, 5> kError{-3.0 / 16, -27.0 / 32, 25.0 / 32, 0.0, 1.0 / 4};
/// Error of Newton's method relative to the allowed error.
constexpr double kNewton = 0.01;
constexpr int kMaxIterations = 10;
/// Safety factor of the step size, and limits of its relative change.
constexpr double kSafety = 0.9, kMinChange = 0.2, kMaxChange = 5.0;

}  // namespace

AdaptiveMotion::AdaptiveMotion(std::shared_ptr<const Arm> arm, const Accuracy& accuracy)
    : equations_(std::move(arm)), accuracy_(accuracy) {
  const Eigen::Index n = equations_.arm().coordinates();
  matrix_ = Eigen::PartialPivLU<MatrixX>(n);
  set_state(VectorX::Zero(n), VectorX::Zero(n));
}

void AdaptiveMotion::set_state(const VectorX& q, const VectorX& rate, double time) {
  q_ = q;
  rate_ = rate;
  acceleration_ = VectorX::Zero(q.size());
  time_ = time;
}

double AdaptiveMotion::size(const VectorX& position, const VectorX& rate) const {
  return std::max(position.cwiseQuotient(allowed_angle_).lpNorm<Eigen::Infinity>(),
                  rate.cwiseQuotient(allowed_rate_).lpNorm<Eigen::Infinity>());
}

bool AdaptiveMotion::solve_stage(std::size_t stage, double h, const VectorX& drive) {
  const double own = kDiagonal * h;
  VectorX& acceleration = stage_acceleration_[stage];
  VectorX& rate = stage_rate_[stage];
  acceleration = stage == 0 ? acceleration_ : stage_acceleration_[stage - 1];
  VectorX start_q = q_, start_rate = rate_;
  for (std::size_t j = 0; j < stage; ++j) {
    start_q += h * kWeight[stage][j] * stage_rate_[j];
    start_rate += h * kWeight[stage][j] * stage_acceleration_[j];
  }
  double before = 0.0;
  for (int k = 0; k < kMaxIterations; ++k) {
    rate = start_rate + own * acceleration;
    stage_q_ = start_q + own * rate;
    change_ = drive - equations_.residual(stage_q_, rate, acceleration);
    change_ = matrix_.solve(change_).eval();
    acceleration += change_;
    const double now = size(own * own * change_, own * change_);
    if (!std::isfinite(now)) return false;
    // With linear convergence, the remaining error is the geometric series of the changes to come.
    const double ratio = k == 0 ? 0.5 : now / before;
    if (ratio >= 1.0 && now > kNewton) return false;
    before = now;
    if (now * ratio <= kNewton * (1.0 - ratio)) {
      rate = start_rate + own * acceleration;
      stage_q_ = start_q + own * rate;
      return true;
    }
  }
  return false;
}

double AdaptiveMotion::error(double h) {
  const double own = kDiagonal * h;
  estimate_q_ = estimate_rate_ = VectorX::Zero(q_.size());
  for (std::size_t j = 0; j < kStages; ++j) {
    estimate_q_ += h * kError[j] * stage_rate_[j];
    estimate_rate_ += h * kError[j] * stage_acceleration_[j];
  }
  // Multiplies the estimate by (I - gamma h J)^-1, which filters the error that stiff motion causes
  // in an embedded formula that is not L-stable (ibid., IV.8, eq. 8.19). J is the Jacobian of (q',
  // H^-1 (B tau - ...)).
  change_ = inertia_ * estimate_rate_ - own * (stiffness_ * estimate_q_);
  estimate_rate_ = matrix_.solve(change_);
  estimate_q_ += own * estimate_rate_;
  return size(estimate_q_, estimate_rate_);
}

std::optional<double> AdaptiveMotion::attempt(double h, const Torque& torque) {
  const double own = kDiagonal * h;
  matrix_.compute(inertia_ + own * damping_ + own * own * stiffness_);
  for (std::size_t stage = 0; stage < kStages; ++stage) {
    const VectorX drive = equations_.arm().actuation() * torque(time_ + kTime[stage] * h);
    if (!solve_stage(stage, h, drive)) return std::nullopt;
  }
  return error(h);
}

void AdaptiveMotion::advance(double end, const Torque& torque) {
  bool moved = true;
  while (time_ < end) {
    const double left = end - time_;
    // Takes two halves rather than one step and a tiny one.
    const bool last = next_ >= left;
    const double h = last ? left : std::min(next_, 0.5 * left);
    if (moved) {
      const auto& linear = equations_.linearise(q_, rate_, acceleration_);
      inertia_ = linear.by_acceleration;
      damping_ = linear.by_rate;
      stiffness_ = linear.by_position;
      allowed_angle_ = accuracy_.relative * q_.cwiseAbs().array() + accuracy_.angle;
      allowed_rate_ = accuracy_.relative * rate_.cwiseAbs().array() + accuracy_.rate;
    }
    const std::optional<double> error = attempt(h, torque);
    moved = error && *error <= 1.0;
    const double change = !error ? kMinChange
                                 : std::clamp(kSafety * std::pow(std::max(*error, 1e-10), -0.25),
                                              kMinChange, moved ? kMaxChange : 1.0);
    // A step shortened by the end does not limit later steps.
    next_ = moved && last ? std::max(next_, h * change) : h * change;
    if (moved) {
      time_ = last ? end : time_ + h;
      q_ = stage_q_;
      rate_ = stage_rate_[kStages - 1];
      acceleration_ = stage_acceleration_[kStages - 1];
      ++steps_;
    }
    const bool too_short = next_ < 1e-13 * std::max(std::abs(end), 1e-3);
    if (too_short || steps_ > accuracy_.max_steps) {
      throw Error(
          ErrorKind::not_converged, {.item = equations_.arm().settings().name},
          fmt::format("{} at {:.6g} s, after {} steps",
                      too_short ? "no step is short enough" : "too many steps", time_, steps_),
          "give torques without jumps between the times given, or ask for less accuracy");
    }
  }
}

}  // namespace sinew::pcc
