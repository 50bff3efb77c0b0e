#include "sinew/pcc/bending_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"

namespace sinew::pcc {

using mechanics::Combination;
using mechanics::Integrator;

namespace {

void require(bool good, ErrorKind kind, const char* item, const std::string& message,
             const char* remedy) {
  if (!good) throw Error(kind, {.item = item}, message, remedy);
}

}  // namespace

BendingMotion::BendingMotion(std::shared_ptr<const BendingActuator> actuator,
                             const BendingState& start, const BendingMotionSettings& settings)
    : actuator_(std::move(actuator)), settings_(settings), state_(start) {
  const BendingEnergies& energies = actuator_->energies();
  require(start.angle >= energies.lowest_angle() && start.angle <= energies.highest_angle(),
          ErrorKind::out_of_range, "angle", fmt::format("it starts at {:g} rad", start.angle),
          "start within a turn, and less far backwards");
  require(std::isfinite(start.rate) && std::isfinite(start.time) && std::isfinite(start.pressure),
          ErrorKind::not_finite, "start", "rate, time or pressure is not a finite number",
          "give finite numbers");
  require(settings.spectral_radius >= 0.0 && settings.spectral_radius <= 1.0,
          ErrorKind::out_of_range, "spectral_radius", fmt::format("{:g}", settings.spectral_radius),
          "give 0 (damps most) to 1 (conserves)");
  state_.acceleration = actuator_->acceleration(start.angle, start.rate, start.pressure);
  if (settings.integrator == Integrator::generalized_alpha) {
    // The initial acceleration is known, so no first step by another integrator is needed.
    first_ = second_ = state_.acceleration;
  }
}

void BendingMotion::prepare(double time_step) {
  require(time_step > 0.0 && std::isfinite(time_step), ErrorKind::out_of_range, "time_step",
          fmt::format("{:g} s", time_step), "give a step above 0 s");
  const bool starts = settings_.integrator == Integrator::generalized_alpha && step_before_ == 0.0;
  const double before = starts ? time_step : step_before_;
  if (time_step == prepared_step_ && before == prepared_before_) return;
  weights_ =
      mechanics::step_weights(settings_.integrator, time_step, before, settings_.spectral_radius);
  prepared_step_ = time_step;
  prepared_before_ = before;
}

const BendingState& BendingMotion::step(double time_step, double pressure) {
  constexpr int kMaxIterations = 50;
  constexpr double kLongestStep = 0.3;  // rad, of a Newton step
  // Newton's method converges quadratically, so after a change of this size the error is its
  // square.
  constexpr double kTolerance = 1e-9;
  prepare(time_step);
  const BendingActuator& model = *actuator_;
  const BendingEnergies& energies = model.energies();
  const double shear = model.parameters().modulus.shear(pressure);
  const double moment = model.moment_per_pressure() * pressure;
  const double alpha = model.parameters().mass_damping;
  const auto known = [&](const Combination& c) {
    return c.velocity * state_.rate + c.first * first_ + c.second * second_;
  };
  const double rate_motion = weights_.velocity.motion, rate_known = known(weights_.velocity);
  const double turn_motion = weights_.acceleration.motion;
  const double turn_known = known(weights_.acceleration);
  const double lowest = energies.lowest_angle() - state_.angle;
  const double highest = energies.highest_angle() - state_.angle;
  double d = weights_.dynamic()
                 ? std::clamp(std::clamp(time_step * state_.rate, -kLongestStep, kLongestStep),
                              lowest, highest)
                 : 0.0;
  for (int k = 0; k < kMaxIterations; ++k) {
    const double v = rate_motion * d + rate_known, a = turn_motion * d + turn_known;
    const BendingTerms t = energies.at(state_.angle + d);
    const double inertia = weights_.dynamic() ? t.inertia.value : 0.0;
    const double damping = model.damping(inertia, shear);
    const double residual = inertia * a + 0.5 * t.inertia.first * v * v + damping * v +
                            shear * t.strain.first + t.gravity.first - moment;
    const double slope = inertia * turn_motion + t.inertia.first * a +
                         0.5 * t.inertia.second * v * v +
                         (t.inertia.first * v + damping) * rate_motion +
                         alpha * t.inertia.first * v + shear * t.strain.second + t.gravity.second;
    const double wanted = std::clamp(-residual / slope, -kLongestStep, kLongestStep);
    d = std::clamp(d + wanted, lowest, highest);
    if (!(std::abs(wanted) < kTolerance)) continue;
    const double end_rate = rate_motion * d + rate_known;
    const double first = weights_.first.motion * d + known(weights_.first);
    const double second = weights_.second.motion * d + known(weights_.second);
    state_ = {state_.time + time_step, state_.angle + d, end_rate, turn_motion * d + turn_known,
              pressure};
    first_ = first;
    second_ = second;
    step_before_ = time_step;
    return state_;
  }
  throw Error(
      ErrorKind::not_converged, {.item = "bending actuator"},
      fmt::format("no angle meets the equation of motion at {:g} s: {:g} Pa, from {:g} rad "
                  "and {:g} rad/s",
                  state_.time + time_step, pressure, state_.angle, state_.rate),
      "take a shorter step, a lower pressure, or exact energies: Taylor models of odd order "
      "give way at large angles");
}

std::vector<BendingState> simulate(std::shared_ptr<const BendingActuator> actuator,
                                   std::span<const double> times, std::span<const double> pressures,
                                   const BendingState& start, double longest_step,
                                   const BendingMotionSettings& settings) {
  require(times.size() == pressures.size(), ErrorKind::wrong_length, "pressures",
          fmt::format("{} times and {} pressures", times.size(), pressures.size()),
          "give a pressure for each time");
  require(times.size() >= 2, ErrorKind::too_few_points, "times",
          fmt::format("the history has {} times", times.size()), "give two or more");
  require(longest_step > 0.0, ErrorKind::out_of_range, "longest_step",
          fmt::format("{:g} s", longest_step), "give a step above 0 s");
  for (std::size_t i = 0; i < times.size(); ++i) {
    require(std::isfinite(times[i]) && std::isfinite(pressures[i]), ErrorKind::not_finite, "times",
            fmt::format("row {} is not finite", i), "leave rows out rather than empty");
    require(i == 0 || times[i] > times[i - 1], ErrorKind::non_monotonic_time, "times",
            fmt::format("{:g} s comes after {:g} s", times[i], times[i == 0 ? 0 : i - 1]),
            "give increasing times");
  }
  BendingState at = start;
  at.time = times[0];
  at.pressure = pressures[0];
  BendingMotion motion(std::move(actuator), at, settings);
  std::vector<BendingState> states{motion.state()};
  states.reserve(times.size());
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double span = times[i] - times[i - 1];
    // An interval slightly longer than the longest step, due to rounding of times, is not divided.
    const auto steps = whole_count<long>(std::max(1.0, std::ceil(span / longest_step - 1e-9)), 1e9,
                                         "steps between two times", "give a longer step");
    const auto count = static_cast<double>(steps);
    for (long k = 1; k <= steps; ++k) {
      const double part = static_cast<double>(k) / count;
      motion.step(span / count, pressures[i - 1] + part * (pressures[i] - pressures[i - 1]));
    }
    states.push_back(motion.state());
    states.back().time = times[i];
  }
  return states;
}

}  // namespace sinew::pcc
