#include "sinew/pcc/bending_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/allocation_guard.hpp"
#include "support/error_kind.hpp"

namespace sinew::pcc {
namespace {

using mechanics::Integrator;
using sinew::testing::kind_of;
using Shared = std::shared_ptr<const BendingActuator>;

Shared actuator(auto change) {
  BendingParameters p;
  p.inclination = 1.2;
  change(p);
  return std::make_shared<const BendingActuator>(p);
}

Shared undamped(std::optional<int> order = 5) {
  return actuator([&](BendingParameters& p) { p.order = order; });
}

/// The classical Runge-Kutta method with a step so small that its error is rounding.
std::pair<double, double> runge_kutta(const BendingActuator& a, double theta, double rate,
                                      double end, const auto& pressure) {
  constexpr int kSteps = 20000;
  const double h = end / kSteps;
  for (int k = 0; k < kSteps; ++k) {
    const double t = h * k;
    const auto f = [&](double s, double q, double v) {
      return a.acceleration(q, v, pressure(t + s));
    };
    const double a1 = f(0, theta, rate), v2 = rate + 0.5 * h * a1;
    const double a2 = f(0.5 * h, theta + 0.5 * h * rate, v2), v3 = rate + 0.5 * h * a2;
    const double a3 = f(0.5 * h, theta + 0.5 * h * v2, v3), v4 = rate + h * a3;
    const double a4 = f(h, theta + h * v3, v4);
    theta += h / 6.0 * (rate + 2.0 * v2 + 2.0 * v3 + v4);
    rate += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  return {theta, rate};
}

double error_after(const Shared& a, Integrator integrator, int steps, const auto& pressure,
                   double expected, double end) {
  BendingMotion motion(a, {.angle = 0.4, .pressure = pressure(0.0)}, {.integrator = integrator});
  const double h = end / steps;
  for (int k = 1; k <= steps; ++k) motion.step(h, pressure(h * k));
  return std::abs(motion.state().angle - expected);
}

TEST(BendingMotion, ConvergesToRungeKuttaWithItsOrder) {
  const Shared a = actuator([](BendingParameters& p) {
    p.mass_damping = 1.0;
    p.stiffness_damping = 2e-3;
    p.mass_line = MassLine::section;
  });
  const auto pressure = [](double t) { return 30e3 * (1.0 - std::cos(20.0 * t)); };
  const double end = 0.1, expected = runge_kutta(*a, 0.4, 0.0, end, pressure).first;
  for (const auto& [integrator, order] :
       {std::pair{Integrator::backward_euler, 1.0}, std::pair{Integrator::bdf2, 2.0},
        std::pair{Integrator::generalized_alpha, 2.0}}) {
    const double coarse = error_after(a, integrator, 1600, pressure, expected, end);
    const double fine = error_after(a, integrator, 3200, pressure, expected, end);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.15) << integrator_name(integrator);
    EXPECT_LT(fine, 2e-2);
  }
}

// Without damping, the sum of strain, gravity and kinetic energy minus the work of a constant
// pressure is conserved, up to an error that decreases with the order of the method.
TEST(BendingMotion, EnergyIsConservedWithTheOrderOfTheMethod) {
  for (const std::optional<int> order : {std::optional<int>(), std::optional(5)}) {
    const Shared a = undamped(order);
    const double pressure = 40e3;
    const auto total = [&](const BendingState& s) {
      return a->energy(s.angle, s.rate, pressure).total() -
             a->moment_per_pressure() * pressure * s.angle;
    };
    const auto drift = [&](Integrator integrator, double radius, int steps) {
      BendingMotion motion(a, {.angle = 0.0, .pressure = pressure},
                           {.integrator = integrator, .spectral_radius = radius});
      const double start = total(motion.state());
      double worst = 0.0;
      for (int k = 0; k < steps; ++k) {
        worst = std::max(worst, std::abs(total(motion.step(0.2 / steps, pressure)) - start));
      }
      return worst;
    };
    const double scale = a->moment_per_pressure() * pressure * a->equilibrium(pressure);
    for (const auto& [integrator, radius, expected] :
         {std::tuple{Integrator::backward_euler, 0.8, 1.0},
          std::tuple{Integrator::generalized_alpha, 1.0, 2.0}}) {
      const double coarse = drift(integrator, radius, 4000), fine = drift(integrator, radius, 8000);
      EXPECT_NEAR(std::log2(coarse / fine), expected, 0.25) << integrator_name(integrator);
      EXPECT_LT(fine, 0.2 * scale) << integrator_name(integrator);
    }
    EXPECT_LT(drift(Integrator::generalized_alpha, 1.0, 4000), 1e-4 * scale);
  }
}

TEST(BendingMotion, SwingsWithTheFrequencyOfStiffnessOverInertia) {
  const Shared a = undamped();
  const double pressure = 50e3, rest = a->equilibrium(pressure);
  const double inertia = a->energies().at(rest).inertia.value;
  const double expected =
      std::sqrt(a->stiffness(rest, pressure) / inertia) / (2.0 * std::numbers::pi);
  BendingMotion motion(a, {.angle = rest + 1e-4, .pressure = pressure}, {.spectral_radius = 1.0});
  const double h = 1e-5;
  int crossings = 0;
  double first = 0.0, last = 0.0, before = 1e-4;
  while (crossings < 21) {
    const double now = motion.step(h, pressure).angle - rest;
    if (now * before < 0.0) {
      last = motion.state().time - h * now / (now - before);
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  EXPECT_NEAR(10.0 / (last - first), expected, 1e-4 * expected);
}

TEST(BendingMotion, DampingTakesEnergyAtEveryStep) {
  const Shared a = actuator([](BendingParameters& p) { p.stiffness_damping = 1e-2; });
  BendingMotion motion(a, {.angle = 1.2}, {.spectral_radius = 1.0});
  double before = a->energy(1.2, 0.0, 0.0).total();
  for (int k = 0; k < 2000; ++k) {
    const BendingState& s = motion.step(1e-4, 0.0);
    const double now = a->energy(s.angle, s.rate, 0.0).total();
    EXPECT_LE(now, before + 1e-9 * std::abs(before));
    before = now;
  }
  EXPECT_NEAR(motion.state().angle, a->equilibrium(0.0), 1e-3);
}

// The phase of the fundamental mode advances by over 10 rad in a step of 0.1 s, where explicit
// methods diverge.
TEST(BendingMotion, IsStableAtStepsThatResolveNothing) {
  for (const std::optional<int> order : {std::optional<int>(), std::optional(5)}) {
    const Shared a = undamped(order);
    const double inertia = a->energies().at(0.0).inertia.value;
    ASSERT_GT(0.1 * std::sqrt(a->stiffness(0.0, 0.0) / inertia), 10.0);
    for (const Integrator integrator :
         {Integrator::backward_euler, Integrator::bdf2, Integrator::generalized_alpha}) {
      BendingMotion motion(a, {.angle = 0.0}, {.integrator = integrator});
      double worst = 0.0;
      for (int k = 0; k < 400; ++k) worst = std::max(worst, motion.step(0.1, 60e3).angle);
      const double rest = a->equilibrium(60e3);
      EXPECT_NEAR(motion.state().angle, rest, 1e-6) << integrator_name(integrator);
      EXPECT_LT(worst, 3.0 * rest) << integrator_name(integrator);
    }
  }
}

TEST(BendingMotion, QuasiStaticStepsAreEquilibria) {
  const Shared a = undamped(std::nullopt);
  BendingMotion motion(a, {}, {.integrator = Integrator::quasi_static});
  for (const double pressure : {10e3, 50e3, 90e3, 20e3}) {
    EXPECT_NEAR(motion.step(0.1, pressure).angle, a->equilibrium(pressure), 1e-9);
  }
}

TEST(BendingMotion, StepsAllocateNothing) {
  if (!sinew::testing::counts_allocations()) return;
  for (const std::optional<int> order : {std::optional<int>(), std::optional(5)}) {
    BendingMotion motion(undamped(order), {});
    motion.step(1e-3, 1e3);
    const long before = sinew::testing::allocations();
    for (int k = 0; k < 100; ++k) motion.step(1e-3, 500.0 * k);
    EXPECT_EQ(sinew::testing::allocations(), before);
  }
}

TEST(BendingMotion, FailedStepLeavesTheState) {
  const Shared a = undamped(std::nullopt);
  BendingMotion motion(a, {.angle = 0.3}, {.integrator = Integrator::quasi_static});
  EXPECT_EQ(kind_of([&] { motion.step(0.01, 1e8); }), ErrorKind::not_converged);
  EXPECT_EQ(motion.state().angle, 0.3);
  EXPECT_EQ(motion.state().time, 0.0);
  EXPECT_EQ(kind_of([&] { motion.step(0.0, 1e3); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { motion.step(-1.0, 1e3); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { BendingMotion(a, {.angle = 9.0}); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { BendingMotion(a, {.angle = NAN}); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { BendingMotion(a, {.rate = NAN}); }), ErrorKind::not_finite);
  EXPECT_EQ(kind_of([&] { BendingMotion(a, {}, {.spectral_radius = 1.1}); }),
            ErrorKind::out_of_range);
}

TEST(Simulate, UnevenHistoriesAgreeWithEvenOnes) {
  const Shared a = actuator([](BendingParameters& p) { p.stiffness_damping = 5e-3; });
  // A ramp given by two points or by many is the same line.
  const std::vector<double> coarse_t{0.0, 1.0}, coarse_p{0.0, 60e3};
  std::vector<double> t, p;
  for (int k = 0; k <= 50; ++k) {
    t.push_back(std::pow(k / 50.0, 1.5));
    p.push_back(60e3 * t.back());
  }
  const auto coarse = simulate(a, coarse_t, coarse_p, {}, 1e-4);
  const auto fine = simulate(a, t, p, {}, 1e-4);
  ASSERT_EQ(coarse.size(), 2U);
  ASSERT_EQ(fine.size(), t.size());
  EXPECT_NEAR(fine.back().angle, coarse.back().angle, 1e-6);
  EXPECT_EQ(fine[7].time, t[7]);
  EXPECT_EQ(fine[7].pressure, p[7]);
}

TEST(Simulate, RefusesBrokenHistories) {
  const Shared a = undamped();
  using V = std::vector<double>;
  const auto kind = [&](const V& t, const V& p, double h) {
    return kind_of([&] { simulate(a, t, p, {}, h); });
  };
  EXPECT_EQ(kind({0.0, 1.0}, {0.0}, 0.01), ErrorKind::wrong_length);
  EXPECT_EQ(kind({0.0}, {0.0}, 0.01), ErrorKind::too_few_points);
  EXPECT_EQ(kind({0.0, 0.0}, {0.0, 1.0}, 0.01), ErrorKind::non_monotonic_time);
  EXPECT_EQ(kind({0.0, NAN}, {0.0, 1.0}, 0.01), ErrorKind::not_finite);
  EXPECT_EQ(kind({0.0, 1.0}, {0.0, 1.0}, 0.0), ErrorKind::out_of_range);
  const Shared fitted =
      actuator([](BendingParameters& p) { p.modulus = BendingModulus::published(); });
  EXPECT_EQ(kind_of([&] {
              simulate(fitted, V{0, 1}, V{20e3, 5e3}, {}, 0.01);
            }),
            ErrorKind::out_of_range);
}

}  // namespace
}  // namespace sinew::pcc
