#include "sinew/pcc/bending_energies.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "bending_reference.hpp"

namespace sinew::pcc {
namespace {

const double kAngles[] = {-2.5, -0.7, -0.01, 0.02, 0.4, 1.3, 2.8, 6.2};

BendingParameters under_water(std::optional<int> order) {
  BendingParameters p;
  p.outer_radius = 9e-3;  // thicker on the far side
  p.filling_density = 1.2;
  p.surroundings_density = 1000.0;
  p.inclination = 0.6;
  p.mass_line = MassLine::section;
  p.order = order;
  return p;
}

TEST(BendingEnergies, ExactOnesAgreeWithClosedForms) {
  BendingParameters p;
  p.inclination = 0.5 * std::numbers::pi;
  p.order.reset();
  const BendingEnergies energies(p);
  const double l = p.length, mass = mass_sum(p).total * l, net = net_mass_sum(p).total * l;
  // The integral over a disc of (a + b x)^-2, x from -1 to 1, is 2 pi/b^2 (a/sqrt(a^2 - b^2) - 1)
  // R^2, and that of (a + b x)^2 is pi R^2 (a^2 + b^2/4).
  const auto disc = [&](double theta, double radius, double centre) {
    const double a = 1.0 + theta * centre / l, b = theta * radius / l;
    const double inverse = 2.0 * std::numbers::pi / (b * b) * (a / std::sqrt(a * a - b * b) - 1.0);
    return radius * radius *
           (std::numbers::pi * (a * a + 0.25 * b * b) + inverse - 2.0 * std::numbers::pi);
  };
  for (const double theta : kAngles) {
    if (std::abs(theta) < 0.1) continue;  // the closed forms cancel
    const BendingTerms terms = energies.at(theta);
    const double square = theta * theta;
    const double inertia = 2.0 * mass * l * l *
                           (1.0 / (6.0 * square) + (1.0 + std::cos(theta)) / (square * square) -
                            2.0 * std::sin(theta) / (square * square * theta));
    EXPECT_NEAR(terms.inertia.value, inertia, 1e-10 * inertia) << theta;
    const double lever = l * (1.0 - std::sin(theta) / theta) / theta;
    EXPECT_NEAR(terms.gravity.value, net * p.gravity * lever, 1e-12 * net * l) << theta;
    const double strain =
        0.5 * l *
        (disc(theta, p.outer(), p.outer()) - disc(theta, p.chamber_radius, p.chamber_height()));
    EXPECT_NEAR(terms.strain.value, strain, 1e-9 * std::abs(strain)) << theta;
  }
}

TEST(BendingEnergies, ExactOnesAgreeWithSumsOverMaterialPoints) {
  for (const MassLine line : {MassLine::layer, MassLine::section}) {
    BendingParameters p = under_water(std::nullopt);
    p.mass_line = line;
    const BendingEnergies energies(p);
    const testing::BruteForce brute{p};
    const double scale = std::abs(brute.gravity(1.0));
    for (const double theta : {-1.1, 0.3, 2.0, 5.0}) {
      const BendingTerms terms = energies.at(theta);
      // The error of the grid, with cells of 1/60 and 1/200.
      EXPECT_NEAR(terms.inertia.value / brute.inertia(theta), 1.0, 3e-4) << theta;
      EXPECT_NEAR(terms.strain.value / brute.strain(theta), 1.0, 3e-4) << theta;
      EXPECT_NEAR(terms.gravity.value, brute.gravity(theta), 3e-4 * scale) << theta;
    }
  }
}

// Five-point differences have an error of h^4/30 times the fifth derivative, and rounding of
// 1e-16/h.
double slope(const std::function<double(double)>& f, double x) {
  constexpr double h = 1e-2;
  return (8.0 * (f(x + h) - f(x - h)) - (f(x + 2.0 * h) - f(x - 2.0 * h))) / (12.0 * h);
}

TEST(BendingEnergies, DerivativesAgreeWithDifferences) {
  for (const std::optional<int> order :
       {std::optional<int>(), std::optional(3), std::optional(8)}) {
    const BendingEnergies energies(under_water(order));
    for (const auto member :
         {&BendingTerms::strain, &BendingTerms::gravity, &BendingTerms::inertia}) {
      for (const double theta : {-1.5, 0.0, 0.4, 2.1}) {
        const Derivatives found = energies.at(theta).*member;
        const Derivatives scale = energies.at(2.5).*member;
        const auto value = [&](double x) { return (energies.at(x).*member).value; };
        const auto first = [&](double x) { return (energies.at(x).*member).first; };
        const double allowed = 1e-6 * (std::abs(scale.value) + std::abs(scale.first));
        EXPECT_NEAR(found.first, slope(value, theta), allowed) << theta;
        EXPECT_NEAR(found.second, slope(first, theta), allowed) << theta;
      }
    }
  }
}

TEST(BendingEnergies, NothingHappensInTheStraightPose) {
  const BendingEnergies energies(under_water(std::nullopt));
  const BendingTerms straight = energies.at(0.0);
  const double small = 1e-7;
  const BendingTerms bent = energies.at(small);
  EXPECT_EQ(straight.strain.value, 0.0);
  EXPECT_EQ(straight.strain.first, 0.0);
  EXPECT_NEAR(bent.strain.first / small, straight.strain.second, 1e-6 * straight.strain.second);
  EXPECT_NEAR(bent.inertia.value, straight.inertia.value, 1e-6 * straight.inertia.value);
  EXPECT_NEAR(energies.at(-small).inertia.value, straight.inertia.value,
              1e-6 * straight.inertia.value);
}

TEST(BendingEnergies, FifthOrderIsTheSeriesByHand) {
  BendingParameters p;
  p.inclination = 0.5 * std::numbers::pi;
  const BendingEnergies energies(p);
  const double l = p.length, theta = 0.9, kappa = theta / l;
  const double mass = mass_sum(p).total * l, net = net_mass_sum(p).total * l;
  const BendingTerms terms = energies.at(theta);
  const double lever = theta / 6.0 - std::pow(theta, 3) / 120.0 + std::pow(theta, 5) / 5040.0;
  EXPECT_NEAR(terms.gravity.value, net * p.gravity * l * lever, 1e-13 * net);
  const double inertia = 1.0 / 20.0 - std::pow(theta, 2) / 504.0 + std::pow(theta, 4) / 25920.0;
  EXPECT_NEAR(terms.inertia.value, mass * l * l * inertia, 1e-13 * mass * l * l);
  // Moments of a disc about a line at the distance c: c^2 + R^2/4, c^3 + 3/4 c R^2,
  // c^4 + 3/2 c^2 R^2 + R^4/8, c^5 + 5/2 c^3 R^2 + 5/8 c R^4 times its area.
  const auto series = [&](double radius, double c) {
    const double r2 = radius * radius, k = kappa;
    return std::numbers::pi * r2 *
           (4.0 * k * k * (c * c + 0.25 * r2) - 4.0 * std::pow(k, 3) * (c * c * c + 0.75 * c * r2) +
            5.0 * std::pow(k, 4) * (std::pow(c, 4) + 1.5 * c * c * r2 + r2 * r2 / 8.0) -
            6.0 * std::pow(k, 5) *
                (std::pow(c, 5) + 2.5 * std::pow(c, 3) * r2 + 0.625 * c * r2 * r2));
  };
  const double strain =
      0.5 * l * (series(p.outer(), p.outer()) - series(p.chamber_radius, p.chamber_height()));
  EXPECT_NEAR(terms.strain.value, strain, 1e-12 * strain);
}

TEST(BendingEnergies, TaylorIsWithinItsBoundWhichIsNoWiderThanNeeded) {
  const BendingEnergies exact(under_water(std::nullopt));
  for (int order = 2; order <= 12; ++order) {
    const BendingEnergies reduced(under_water(order));
    for (const double end : {-2.0, -0.5, 0.5, 1.5, 3.0}) {
      const double lowest = std::min(0.0, end), highest = std::max(0.0, end);
      const TaylorBound bound = reduced.bound(lowest, highest);
      TaylorBound worst;
      for (int k = 0; k <= 50; ++k) {
        const double theta = lowest + (highest - lowest) * k / 50;
        const BendingTerms a = exact.at(theta), b = reduced.at(theta);
        const auto keep = [](double& most, double x, double y) {
          most = std::max(most, std::abs(x - y));
        };
        keep(worst.strain, a.strain.value, b.strain.value);
        keep(worst.strain_slope, a.strain.first, b.strain.first);
        keep(worst.gravity, a.gravity.value, b.gravity.value);
        keep(worst.gravity_slope, a.gravity.first, b.gravity.first);
        keep(worst.inertia, a.inertia.value, b.inertia.value);
      }
      // Rounding is relative to the terms, if the bound is far below them.
      const BendingTerms size = exact.at(end);
      const double slack = 1e-14;
      EXPECT_LE(worst.strain, bound.strain + slack * size.strain.value) << order << ' ' << end;
      EXPECT_LE(worst.strain_slope, bound.strain_slope + slack * std::abs(size.strain.first));
      EXPECT_LE(worst.gravity, bound.gravity + slack * 0.1) << order << ' ' << end;
      EXPECT_LE(worst.gravity_slope, bound.gravity_slope + slack * 0.1);
      EXPECT_LE(worst.inertia, bound.inertia + slack * size.inertia.value) << order << ' ' << end;
      if (end < 0.0 || end > 2.0) continue;
      EXPECT_GT(worst.strain, 0.2 * bound.strain) << order << ' ' << end;
      if (bound.gravity > 1e-13) {
        EXPECT_GT(worst.gravity, 0.02 * bound.gravity) << order;
      }
    }
  }
}

TEST(BendingEnergies, TaylorConvergesWithItsOrder) {
  const BendingEnergies exact(under_water(std::nullopt));
  const double theta = 1.0, wanted = exact.at(theta).strain.value;
  for (const int order : {4, 6, 8}) {
    const auto error = [&](double angle, int n) {
      return std::abs(BendingEnergies(under_water(n)).at(angle).strain.value -
                      exact.at(angle).strain.value);
    };
    // Half the angle divides the error by 2^(order + 1), slightly less due to the next term.
    const double rate = std::log2(error(theta, order) / error(0.5 * theta, order));
    EXPECT_NEAR(rate, order + 1, 0.25) << order;
    EXPECT_LT(error(theta, order), 0.02 * wanted);
  }
}

}  // namespace
}  // namespace sinew::pcc
