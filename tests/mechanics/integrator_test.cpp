// Integrators on the oscillator u'' + 2 z w u' + w^2 u = 0, whose motion is known in closed form.
#include "sinew/mechanics/integrator.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace sinew::mechanics {
namespace {

constexpr double kFrequency = 7.0, kDamping = 0.1;  // rad/s; of critical
constexpr double kEnd = 0.8;                        // s

// u and u' from u(0) = 1, u'(0) = 0.
std::array<double, 2> exact(double time) {
  const double decay = kDamping * kFrequency;
  const double turning = kFrequency * std::sqrt(1.0 - kDamping * kDamping);
  const double c = std::cos(turning * time), s = std::sin(turning * time);
  const double shrunk = std::exp(-decay * time);
  return {shrunk * (c + decay / turning * s), -shrunk * (turning + decay * decay / turning) * s};
}

class Oscillator {
 public:
  double position = 1.0, velocity = 0.0, first = 0.0, second = 0.0;

  // a + 2 z w v + w^2 (q_start + d) = 0 at the end of the step.
  void step(const StepWeights& weights) {
    const Combination &v = weights.velocity, &a = weights.acceleration;
    const double damping = 2.0 * kDamping * kFrequency, stiffness = kFrequency * kFrequency;
    const double known = rest_of(a) + damping * rest_of(v) + stiffness * position;
    const double motion = -known / (a.motion + damping * v.motion + stiffness);
    const auto combined = [&](const Combination& c) { return c.motion * motion + rest_of(c); };
    const double next_velocity = combined(v);
    const double next_first = combined(weights.first), next_second = combined(weights.second);
    velocity = next_velocity;
    first = next_first;
    second = next_second;
    position += motion;
  }

 private:
  double rest_of(const Combination& c) const {
    return c.velocity * velocity + c.first * first + c.second * second;
  }
};

// Error of position and velocity at the end. @param uneven whether lengths of steps alternate.
double error_of(Integrator integrator, int steps, bool uneven = false) {
  Oscillator oscillator;
  double before = 0.0, time = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double mean = kEnd / steps;
    const double length = uneven ? mean * (k % 2 == 0 ? 1.25 : 0.75) : mean;
    oscillator.step(step_weights(integrator, length, before));
    time += length;
    before = length;
  }
  const auto [position, velocity] = exact(time);
  return std::hypot(kFrequency * (oscillator.position - position), oscillator.velocity - velocity);
}

double order_of(Integrator integrator, bool uneven = false) {
  return std::log2(error_of(integrator, 400, uneven) / error_of(integrator, 800, uneven));
}

TEST(Integrators, HaveTheirOrder) {
  EXPECT_NEAR(order_of(Integrator::backward_euler), 1.0, 0.03);
  EXPECT_NEAR(order_of(Integrator::bdf2), 2.0, 0.05);
  EXPECT_NEAR(order_of(Integrator::bdf2, true), 2.0, 0.05);
  EXPECT_NEAR(order_of(Integrator::generalized_alpha), 2.0, 0.05);
}

// The implicit midpoint rule: the half step of backward Euler, repeated.
TEST(Integrators, TheMidpointRuleKeepsTheEnergyOfLinearMotion) {
  double position = 1.0, velocity = 0.5;
  const double h = 0.05, stiffness = kFrequency * kFrequency;
  const StepWeights half = step_weights(Integrator::event_driven, 0.5 * h);
  const StepWeights whole = midpoint_weights(h);
  const auto energy = [&] { return 0.5 * (velocity * velocity + stiffness * position * position); };
  const double before = energy();
  for (int k = 0; k < 1000; ++k) {
    const double known = half.acceleration.velocity * velocity + stiffness * position;
    const double motion = 2.0 * -known / (half.acceleration.motion + stiffness);
    velocity = whole.velocity.motion * motion + whole.velocity.velocity * velocity;
    position += motion;
  }
  EXPECT_NEAR(energy(), before, 1e-11 * before);
}

// Motion that is much faster than the step shrinks by rho in every step, once the factor k of the
// double eigenvalue is taken out; with rho = 0 it vanishes.
TEST(Integrators, TheSpectralRadiusIsThatOfFastMotion) {
  const double h = 1e5 / kFrequency;
  const auto size_after = [&](double radius, int steps) {
    Oscillator oscillator;
    oscillator.step(step_weights(Integrator::generalized_alpha, h));
    for (int k = 0; k < steps; ++k) {
      oscillator.step(step_weights(Integrator::generalized_alpha, h, h, radius));
    }
    return std::hypot(kFrequency * oscillator.position, oscillator.velocity);
  };
  for (const double radius : {0.3, 0.5, 0.8}) {
    const double ratio = size_after(radius, 60) / size_after(radius, 40);
    EXPECT_NEAR(std::pow(ratio / 1.5, 1.0 / 20.0), radius, 0.02 * radius);
  }
  EXPECT_LT(size_after(0.0, 10), 1e-20);
}

TEST(Integrators, AConstantAccelerationIsExact) {
  for (const Integrator integrator : {Integrator::bdf2, Integrator::generalized_alpha}) {
    // d = h v + h^2 g / 2 and v' = v + h g satisfy the weights with their history.
    const double h = 0.1, g = 9.81;
    double velocity = 2.0;
    const StepWeights weights = step_weights(integrator, h, h);
    const double motion = h * velocity + 0.5 * h * h * g;
    const bool bdf = integrator == Integrator::bdf2;
    const double motion_before = h * (velocity - h * g) + 0.5 * h * h * g;
    const double first = bdf ? motion_before : g, second = bdf ? velocity - h * g : g;
    const auto combined = [&](const Combination& c) {
      return c.motion * motion + c.velocity * velocity + c.first * first + c.second * second;
    };
    EXPECT_NEAR(combined(weights.velocity), velocity + h * g, 1e-12);
    EXPECT_NEAR(combined(weights.acceleration), g, 1e-11);
  }
}

TEST(Integrators, HaveNames) {
  EXPECT_EQ(integrator_name(Integrator::quasi_static), "quasi-static");
  EXPECT_EQ(integrator_name(Integrator::event_driven), "event-driven");
  EXPECT_EQ(history_count(Integrator::backward_euler), 0);
  EXPECT_EQ(history_count(Integrator::bdf2), 2);
  EXPECT_FALSE(step_weights(Integrator::quasi_static, 0.1).dynamic());
  EXPECT_TRUE(step_weights(Integrator::backward_euler, 0.1).dynamic());
}

}  // namespace
}  // namespace sinew::mechanics
