#include "sinew/pcc/bending_actuator.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "bending_reference.hpp"
#include "support/error_kind.hpp"

namespace sinew::pcc {
namespace {

using sinew::testing::kind_of;

BendingParameters damped() {
  BendingParameters p;
  p.inclination = 1.1;
  p.filling_density = p.surroundings_density = 1000.0;
  p.mass_damping = 2.0;
  p.stiffness_damping = 0.01;
  p.order.reset();
  return p;
}

TEST(BendingActuator, MomentIsThatOfThePressureOnTheEndCap) {
  BendingParameters p;
  p.outer_radius = 10e-3;
  const BendingActuator actuator(p);
  // Sums over strips of the chamber's disc, by their height above the layer.
  double moment = 0.0;
  constexpr int kStrips = 20000;
  for (int i = 0; i < kStrips; ++i) {
    const double y = p.chamber_radius * (2.0 * (i + 0.5) / kStrips - 1.0);
    const double width = 2.0 * std::sqrt(p.chamber_radius * p.chamber_radius - y * y);
    moment += (p.chamber_height() + y) * width * 2.0 * p.chamber_radius / kStrips;
  }
  EXPECT_NEAR(actuator.moment_per_pressure(), moment, 1e-5 * moment);
  // Work of the pressure, from the volume of the bent chamber, cell by cell.
  const auto volume = [&](double theta) {
    double sum = 0.0;
    for (int i = 0; i < kStrips; ++i) {
      const double y = p.chamber_radius * (2.0 * (i + 0.5) / kStrips - 1.0);
      const double width = 2.0 * std::sqrt(p.chamber_radius * p.chamber_radius - y * y);
      sum +=
          (p.length + (p.chamber_height() + y) * theta) * width * 2.0 * p.chamber_radius / kStrips;
    }
    return sum;
  };
  EXPECT_NEAR((volume(1.1) - volume(0.9)) / 0.2, moment, 1e-9 * moment);
  EXPECT_NEAR(actuator.chamber_volume(0.8), volume(0.8), 1e-5 * volume(0.8));
}

// Compares the closed form with d/dt dL/dtheta' - dL/dtheta = Q, where L is a sum over material
// points and its derivatives are finite differences.
TEST(BendingActuator, EquationOfMotionIsThatOfTheDifferentiatedLagrangian) {
  for (const MassLine line : {MassLine::layer, MassLine::section}) {
    BendingParameters p = damped();
    p.mass_line = line;
    const BendingActuator actuator(p);
    const testing::BruteForce brute{.p = p, .along = 120, .rings = 40, .turns = 60};
    const double shear = p.modulus.shear(0.0), step = 0.02;
    const auto lagrangian = [&](double theta, double rate) {
      return 0.5 * brute.inertia(theta) * rate * rate - shear * brute.strain(theta) -
             brute.gravity(theta);
    };
    for (const auto& at :
         {std::array{0.7, 3.0, 40e3}, std::array{1.6, -12.0, 80e3}, std::array{-0.5, 6.0, 0.0}}) {
      const double theta = at[0], rate = at[1], pressure = at[2];
      // T is quadratic in the rate, so a difference of 1 rad/s is exact.
      const auto momentum = [&](double angle) {
        return 0.5 * (lagrangian(angle, rate + 1.0) - lagrangian(angle, rate - 1.0));
      };
      const double inertia =
          lagrangian(theta, 1.0) + lagrangian(theta, -1.0) - 2.0 * lagrangian(theta, 0.0);
      const double carried =
          (momentum(theta + step) - momentum(theta - step)) / (2.0 * step) * rate;
      const double slope =
          (lagrangian(theta + step, rate) - lagrangian(theta - step, rate)) / (2.0 * step);
      // The stiffness part of Rayleigh damping is that of the straight pose, from a second
      // difference there.
      const double straight = (brute.strain(step) + brute.strain(-step)) / (step * step);
      const double friction =
          (p.mass_damping * inertia + p.stiffness_damping * shear * straight) * rate;
      const double moment = pressure * std::numbers::pi * p.chamber_radius * p.chamber_radius *
                            (p.chamber_radius + p.wall_thickness);
      const double expected = (moment + slope - carried - friction) / inertia;
      const double found = actuator.acceleration(theta, rate, pressure);
      // Grid and differences have errors of 1e-3 of the terms, which nearly cancel.
      const double size = (moment + std::abs(slope) + std::abs(friction)) / inertia;
      EXPECT_NEAR(found, expected, 2e-3 * size) << theta;
    }
  }
}

TEST(BendingActuator, SmallAnglesAreThoseOfTheBeam) {
  BendingParameters p;
  p.gravity = 0.0;
  for (const std::optional<int> order :
       {std::optional<int>(), std::optional(2), std::optional(5)}) {
    p.order = order;
    p.modulus = BendingModulus(0.8e6, ModulusKind::bending);
    const BendingActuator actuator(p);
    const double moment = actuator.moment_per_pressure() * 100.0;
    EXPECT_NEAR(actuator.linear_angle(100.0),
                moment * p.length / (0.8e6 * actuator.second_moment()), 1e-15);
    EXPECT_NEAR(actuator.equilibrium(100.0) / actuator.linear_angle(100.0), 1.0, 3e-4);
  }
  // The second moment of a ring about its centre, shifted by its radius (parallel axis theorem).
  const double outer = p.outer(), r = p.chamber_radius;
  const double area = std::numbers::pi * (outer * outer - r * r);
  EXPECT_NEAR(BendingActuator(p).second_moment(),
              std::numbers::pi / 4.0 * (std::pow(outer, 4) - std::pow(r, 4)) + area * outer * outer,
              1e-20);
}

TEST(BendingActuator, EquilibriumBalancesAndIsStable) {
  const BendingActuator actuator(damped());
  for (const double pressure : {-20e3, 0.0, 30e3, 120e3}) {
    const double theta = actuator.equilibrium(pressure);
    EXPECT_NEAR(actuator.acceleration(theta, 0.0, pressure), 0.0, 1e-7) << pressure;
    EXPECT_GT(actuator.stiffness(theta, pressure), 0.0);
  }
  // Far beyond the pressure that curls it up.
  EXPECT_EQ(kind_of([&] { actuator.equilibrium(5e6); }), ErrorKind::not_converged);
}

TEST(BendingActuator, HeavyStandingActuatorFallsToOneSide) {
  BendingParameters p;
  p.inclination = std::numbers::pi;  // stands
  p.modulus = BendingModulus(2e3);
  p.order.reset();
  const BendingActuator actuator(p);
  EXPECT_LT(actuator.stiffness(0.0, 0.0), 0.0);
  const double theta = actuator.equilibrium(0.0, 0.1);
  EXPECT_GT(theta, 0.2);
  EXPECT_NEAR(actuator.acceleration(theta, 0.0, 0.0), 0.0, 1e-6);
}

TEST(BendingActuator, WeightLessBuoyancy) {
  BendingParameters p;
  p.filling_density = p.surroundings_density = 1000.0;
  const double outer = p.outer(), r = p.chamber_radius;
  const double wall = std::numbers::pi * (outer * outer - r * r) * p.length,
               inside = std::numbers::pi * r * r * p.length;
  EXPECT_NEAR(BendingActuator(p).net_weight(), (1070.0 - 1000.0) * wall * 9.81, 1e-12);
  p.filling_density = 0.0;  // empty in water, so it floats
  EXPECT_NEAR(BendingActuator(p).net_weight(), (70.0 * wall - 1000.0 * inside) * 9.81, 1e-12);
  EXPECT_LT(BendingActuator(p).net_weight(), 0.0);
  p.surroundings_density = 0.0;
  EXPECT_NEAR(BendingActuator(p).net_weight(), 1070.0 * wall * 9.81, 1e-12);
  EXPECT_NEAR(BendingActuator(p).mass(), 1070.0 * wall, 1e-12);
}

TEST(BendingActuator, PointsLieOnTheArc) {
  BendingParameters p;
  p.inclination = 0.8;
  const BendingActuator actuator(p);
  for (const double theta : {-1.2, -1e-5, 0.0, 1e-5, 0.6, 3.0}) {
    // Checks the formula of the arc in the frame of the base, and the length of a fine polyline.
    double length = 0.0;
    Eigen::Vector2d before = actuator.point(theta, 0.0);
    EXPECT_LT(before.norm(), 1e-15);
    for (int i = 1; i <= 1000; ++i) {
      const Eigen::Vector2d at = actuator.point(theta, i / 1000.0);
      length += (at - before).norm();
      before = at;
    }
    EXPECT_NEAR(length, p.length, 1e-6 * p.length) << theta;
    if (std::abs(theta) > 1e-3) {
      const auto expected = testing::BruteForce{p}.place(theta, 1.0, 0.0);
      EXPECT_NEAR(before.x(), expected.x, 1e-14);
      EXPECT_NEAR(before.y(), expected.z, 1e-14);
    }
  }
  p.inclination = 0.0;
  EXPECT_NEAR(BendingActuator(p).point(0.0).y(), -p.length, 1e-15);
  EXPECT_GT(BendingActuator(p).point(0.5).x(), 0.0);
}

TEST(BendingActuator, TaylorErrorHoldsForForces) {
  BendingParameters p = damped();
  const BendingActuator exact(p);
  p.order = 5;
  const BendingActuator reduced(p);
  const BendingError bound = reduced.taylor_error(0.0, 1.5, 50e3);
  double worst = 0.0;
  for (int k = 0; k <= 30; ++k) {
    const double theta = 1.5 * k / 30;
    const auto force = [&](const BendingActuator& a) {
      const BendingTerms t = a.energies().at(theta);
      return p.modulus.shear(50e3) * t.strain.first + t.gravity.first;
    };
    worst = std::max(worst, std::abs(force(exact) - force(reduced)));
  }
  EXPECT_LE(worst, bound.torque);
  EXPECT_GT(worst, 0.1 * bound.torque);
  EXPECT_EQ(exact.taylor_error(0.0, 1.5, 50e3).torque, 0.0);
  EXPECT_EQ(kind_of([&] { reduced.taylor_error(1.0, 0.0, 0.0); }), ErrorKind::contradictory_limits);
  EXPECT_EQ(kind_of([&] { reduced.taylor_error(0.0, 7.0, 0.0); }), ErrorKind::out_of_range);
}

TEST(BendingActuator, RefusesAnglesOfNoActuator) {
  const BendingActuator actuator(damped());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double theta : {-6.0, 7.0, nan}) {
    EXPECT_EQ(kind_of([&] { actuator.acceleration(theta, 0.0, 0.0); }), ErrorKind::out_of_range);
    EXPECT_EQ(kind_of([&] { actuator.energy(theta, 0.0, 0.0); }), ErrorKind::out_of_range);
    EXPECT_EQ(kind_of([&] { actuator.stiffness(theta, 0.0); }), ErrorKind::out_of_range);
    EXPECT_EQ(kind_of([&] { actuator.terms(theta); }), ErrorKind::out_of_range);
  }
}

TEST(BendingActuator, RefusesWhatCannotBe) {
  const auto kind = [](auto change) {
    BendingParameters p;
    change(p);
    return kind_of([&] { BendingActuator{p}; });
  };
  using P = BendingParameters;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(kind([](P&) {}), ErrorKind::internal);
  EXPECT_EQ(kind([](P& p) { p.length = -0.1; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](P& p) { p.length = 0.01; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([&](P& p) { p.length = nan; }), ErrorKind::not_finite);
  EXPECT_EQ(kind([](P& p) { p.chamber_radius = 0.0; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](P& p) { p.wall_thickness = 0.0; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](P& p) { p.outer_radius = 7e-3; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](P& p) { p.silicone_density = 0.0; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](P& p) { p.filling_density = -1.0; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](P& p) { p.surroundings_density = -1.0; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([&](P& p) { p.inclination = nan; }), ErrorKind::not_finite);
  EXPECT_EQ(kind([](P& p) { p.gravity = -9.81; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](P& p) { p.mass_damping = -1.0; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](P& p) { p.stiffness_damping = -1.0; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](P& p) { p.order = 1; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](P& p) { p.order = 21; }), ErrorKind::out_of_range);
}

TEST(BendingModulus, KindsDifferByTheirStressState) {
  EXPECT_DOUBLE_EQ(BendingModulus(1.0).shear(0.0), 1.0);
  EXPECT_DOUBLE_EQ(BendingModulus(3.0, ModulusKind::young).shear(1e9), 1.0);
  EXPECT_DOUBLE_EQ(BendingModulus(4.0, ModulusKind::bending).shear(-1e9), 1.0);
}

TEST(BendingModulus, PolynomialWithinItsRangeOnly) {
  const BendingModulus modulus = BendingModulus::published();
  // 6.562e5 + 7.985e5 - 1.3915e6 + 1.066875e6 - 3.975e5 + 5.609375e4, term by term by hand.
  EXPECT_NEAR(modulus.value(50e3), 788668.75, 1e-6);
  EXPECT_NEAR(modulus.shear(50e3), 788668.75 / 4.0, 1e-6);
  EXPECT_EQ(kind_of([&] { modulus.value(9.9e3); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { modulus.value(111e3); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { modulus.value(std::nan("")); }), ErrorKind::out_of_range);
  const BendingModulus held = BendingModulus::published(OutsideRange::hold);
  EXPECT_EQ(held.value(0.0), held.value(10e3));
  EXPECT_EQ(held.value(1e6), held.value(110e3));
  EXPECT_NE(held.value(10e3), held.value(110e3));
}

TEST(BendingModulus, RefusesWhatIsNoModulus) {
  const auto fit = [](std::vector<double> c, double low, double high) {
    return kind_of([&] { BendingModulus(std::move(c), ModulusKind::young, low, high); });
  };
  EXPECT_EQ(fit({1e5, 1.0}, 0.0, 1e5), ErrorKind::internal);
  EXPECT_EQ(fit({}, 0.0, 1e5), ErrorKind::empty_list);
  EXPECT_EQ(fit({1e5, -2.0}, 0.0, 1e5), ErrorKind::out_of_range);
  EXPECT_EQ(fit({1e5, std::nan("")}, 0.0, 1e5), ErrorKind::not_finite);
  EXPECT_EQ(fit({1e5}, 1e5, 0.0), ErrorKind::contradictory_limits);
  // The published polynomial is negative at -25 kPa.
  EXPECT_EQ(fit(BendingModulus::published().coefficients(), -25e3, 110e3), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([] { BendingModulus(0.0); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([] { BendingModulus{std::numeric_limits<double>::infinity()}; }),
            ErrorKind::not_finite);
  EXPECT_EQ(kind_of([] { to_modulus_kind("bulk"); }), ErrorKind::unknown_choice);
  EXPECT_EQ(kind_of([] { to_outside_range("guess"); }), ErrorKind::unknown_choice);
  EXPECT_EQ(modulus_kind_name(to_modulus_kind("bending")), "bending");
  EXPECT_EQ(outside_range_name(to_outside_range("hold")), "hold");
}

}  // namespace
}  // namespace sinew::pcc
