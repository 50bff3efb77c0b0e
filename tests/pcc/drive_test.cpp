// Fluidic actuators, drive cylinders and excitation signals.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include "sinew/core/random.hpp"
#include "sinew/pcc/drive_cylinder.hpp"
#include "sinew/pcc/excitation.hpp"
#include "sinew/pcc/fluidic_actuator.hpp"

#include "support/error_kind.hpp"

namespace sinew::pcc {
namespace {

using sinew::testing::kind_of;

constexpr double kTurn = 2.0 * std::numbers::pi;

TEST(FluidicActuator, VolumeInvertsTorque) {
  Random random(3);
  for (const double linear : {0.0, 1e-9, 1.0, 800.0, 1e6}) {
    for (const double cubic : {4e12, 1.0, 1e-6}) {
      const FluidicActuator actuator{linear, cubic, 0.0};
      for (int i = 0; i < 50; ++i) {
        const double torque = random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-6.0, 1.0));
        EXPECT_NEAR(actuator.torque(actuator.volume(torque)), torque, 1e-13 * std::abs(torque))
            << linear << " " << cubic;
      }
      EXPECT_EQ(actuator.volume(0.0), 0.0);
    }
  }
  const FluidicActuator pure{0.0, 8.0, 0.0};
  EXPECT_DOUBLE_EQ(pure.volume(-1.0), -0.5);
  EXPECT_DOUBLE_EQ((FluidicActuator{4.0, 0.0, 0.0}).volume(2.0), 0.5);
}

TEST(FluidicActuator, RefusesWhatCannotBe) {
  EXPECT_EQ(kind_of([] { FluidicActuator{-1.0, 1.0, 0.0}.check(); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([] { FluidicActuator{0.0, 0.0, 0.0}.check(); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([] { FluidicActuator{0.0, 1.0, -0.1}.check(); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([] { FluidicActuator{0.0, NAN, 0.0}.check(); }), ErrorKind::not_finite);
}

TEST(DriveCylinder, FollowsTheStepResponseOfASecondOrderSystem) {
  // y = g (1 - e^(-zeta w t) (cos(w_d t) + zeta w/w_d sin(w_d t))).
  const double gain = 0.7, w = 12.0, zeta = 0.35, h = 0.01;
  const auto cylinder = DriveCylinder::second_order(gain, w, zeta, h);
  const VectorX y = cylinder.simulate(VectorX::Ones(200));
  const double wd = w * std::sqrt(1.0 - zeta * zeta);
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const double t = h * static_cast<double>(k);
    const double exact = gain * (1.0 - std::exp(-zeta * w * t) *
                                           (std::cos(wd * t) + zeta * w / wd * std::sin(wd * t)));
    EXPECT_NEAR(y[k], exact, 1e-12);
  }
  EXPECT_NEAR(cylinder.gain(), gain, 1e-12);
  EXPECT_NEAR(cylinder.spectral_radius(), std::exp(-zeta * w * h), 1e-12);
}

/// exp(a) by the series for a / 2^k, squared k times.
Matrix3 exponential(const Matrix3& a) {
  const int halvings = std::max(0, static_cast<int>(std::ceil(std::log2(a.norm()))) + 1);
  const Matrix3 small = a / std::pow(2.0, halvings);
  Matrix3 result = Matrix3::Identity(), term = Matrix3::Identity();
  for (int k = 1; k < 24; ++k) {
    term = term * small / k;
    result += term;
  }
  for (int k = 0; k < halvings; ++k) result = result * result;
  return result;
}

// exp of [F G; 0 0] h is [A B; 0 1] (Van Loan, IEEE Trans. Automatic Control 23, 1978).
TEST(DriveCylinder, IsTheMatrixExponentialForAnyDamping) {
  const double w = 15.0, h = 0.02;
  constexpr double kSquarings = 1e-13;  // rounding of the reference, doubled five times
  for (const double zeta : {0.0, 0.4, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 3.0, 20.0}) {
    const auto cylinder = DriveCylinder::second_order(1.0, w, zeta, h);
    Matrix3 continuous = Matrix3::Zero();
    continuous.topRows<2>() << 0.0, w, 0.0, -w, -2.0 * zeta * w, w;
    const Matrix3 held = exponential(h * continuous);
    EXPECT_LT((cylinder.a - held.topLeftCorner<2, 2>()).norm(), kSquarings) << zeta;
    EXPECT_LT((cylinder.b - held.topRightCorner<2, 1>()).norm(), kSquarings) << zeta;
  }
  // A mode that has decayed completely gives zeros, not infinity times zero.
  const auto stiff = DriveCylinder::second_order(1.0, 1e3, 1e3, 1.0);
  EXPECT_TRUE(stiff.a.allFinite());
  EXPECT_NEAR(stiff.a(0, 0), std::exp(-0.5), 1e-6);
}

TEST(DriveCylinder, TellsTheSpectralRadiusOfAnyMatrix) {
  DriveCylinder cylinder;
  cylinder.a << 0.5, 0.2, 0.1, -0.7;  // -0.1 -+ sqrt(0.6^2 + 0.2 * 0.1)
  const double root = std::sqrt(0.6 * 0.6 + 0.2 * 0.1);
  EXPECT_NEAR(cylinder.spectral_radius(), 0.1 + root, 1e-15);
  cylinder.a << 0.3, -0.8, 0.5, 0.3;  // 0.3 -+ i sqrt(0.4)
  EXPECT_NEAR(cylinder.spectral_radius(), std::hypot(0.3, std::sqrt(0.4)), 1e-15);
}

TEST(DriveCylinder, KeepsItsLimits) {
  auto cylinder = DriveCylinder::second_order(1.0, 20.0, 0.7, 0.01);
  cylinder.lowest_input = -0.5;
  cylinder.highest_input = 0.5;
  EXPECT_NEAR(cylinder.simulate(VectorX::Constant(500, 3.0))[499], 0.5, 1e-9);
  cylinder.highest_volume = 0.4;
  EXPECT_EQ(cylinder.simulate(VectorX::Constant(500, 3.0)).maxCoeff(), 0.4);
  cylinder.lowest_volume = 0.6;
  EXPECT_EQ(kind_of([&] { cylinder.check(); }), ErrorKind::contradictory_limits);
  EXPECT_EQ(kind_of([] { DriveCylinder::second_order(1.0, -1.0, 0.5, 0.01); }),
            ErrorKind::out_of_range);
  DriveCylinder unstable;
  unstable.a << 1.1, 0.0, 0.0, 0.5;
  EXPECT_EQ(kind_of([&] { unstable.check(); }), ErrorKind::out_of_range);
}

TEST(Bretschneider, EnergyIsTheIntegralOfTheDensity) {
  const BretschneiderSpectrum spectrum{kTurn, 3.0};
  double sum = 0.0;
  const double step = 1e-3;
  for (double w = 0.5 * step; w < 20.0; w += step) sum += step * spectrum.density(w);
  EXPECT_NEAR(sum, spectrum.energy(20.0), 1e-6);
  EXPECT_NEAR(spectrum.energy(1e6), 9.0 / 16.0, 1e-12);
  // The peak is at w_p.
  EXPECT_GT(spectrum.density(kTurn), spectrum.density(0.99 * kTurn));
  EXPECT_GT(spectrum.density(kTurn), spectrum.density(1.01 * kTurn));
}

TEST(Excitation, HasTheSpectrumThatWasAskedFor) {
  // Compares periodograms of sampled signals, averaged over seeds and summed over bands of four
  // sines, with the integral of S over these bands.
  constexpr int kSamples = 4096, kSeeds = 4, kBands = 10;
  constexpr double kRate = 16.0;
  const ExcitationSettings settings{.amplitude = 1.5};
  const BretschneiderSpectrum spectrum{kTurn, 2.0 * settings.amplitude};
  const double width = (settings.highest - settings.lowest) / kBands;
  std::vector<double> found(kBands, 0.0);
  double variance = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    auto own = settings;
    own.seed = static_cast<std::uint64_t>(seed);
    const VectorX signal =
        Excitation(own).sample(VectorX::LinSpaced(kSamples, 0.0, (kSamples - 1) / kRate));
    variance += signal.squaredNorm() / kSamples / kSeeds;
    for (int bin = 1; bin < kSamples / 2; ++bin) {
      const double frequency = bin * kRate / kSamples;
      const int band = static_cast<int>(std::floor((frequency - settings.lowest) / width));
      if (band < 0 || band >= kBands) continue;
      const auto turn = std::polar(1.0, -kTurn * bin / kSamples);
      std::complex<double> phase = 1.0, sum = 0.0;
      for (const double value : signal) {
        sum += value * phase;
        phase *= turn;
      }
      found[static_cast<std::size_t>(band)] += 2.0 * std::norm(sum) / kSamples / kSamples / kSeeds;
    }
  }
  for (int band = 0; band < kBands; ++band) {
    const double low = kTurn * (settings.lowest + band * width), high = low + kTurn * width;
    double wanted = 0.0;
    const double step = (high - low) / 1000;
    for (double w = low + 0.5 * step; w < high; w += step) wanted += step * spectrum.density(w);
    EXPECT_NEAR(found[static_cast<std::size_t>(band)], wanted, 0.05 * wanted) << "band " << band;
  }
  // The band contains nearly all of (V_max/2)^2.
  EXPECT_NEAR(variance, 0.25 * settings.amplitude * settings.amplitude, 0.01);
}

TEST(Excitation, IsTheSameEverywhere) {
  // The published sequence of SplitMix64 for the seed 1234567.
  Random random(1234567);
  EXPECT_EQ(random.bits(), 6457827717110365317u);
  EXPECT_EQ(random.bits(), 3203168211198807973u);
  const Excitation a({.seed = 7}), b({.seed = 7}), c({.seed = 8});
  EXPECT_EQ(a.at(1.3), b.at(1.3));
  EXPECT_NE(a.at(1.3), c.at(1.3));
  EXPECT_EQ(kind_of([] { Excitation({.amplitude = 0.0}); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([] { Excitation({.lowest = 2.0, .highest = 1.0}); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([] { Excitation({.sines = 0}); }), ErrorKind::out_of_range);
}

TEST(Random, IsUniformAndNormal) {
  Random random(5);
  double mean = 0.0, square = 0.0, normal = 0.0, spread = 0.0, fourth = 0.0;
  constexpr int kDraws = 200000;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform(), z = random.normal();
    mean += u / kDraws;
    square += u * u / kDraws;
    normal += z / kDraws;
    spread += z * z / kDraws;
    fourth += z * z * z * z / kDraws;
  }
  // Five standard errors each.
  EXPECT_NEAR(mean, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / kDraws));
  EXPECT_NEAR(square, 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / kDraws));
  EXPECT_NEAR(normal, 0.0, 5.0 / std::sqrt(kDraws));
  EXPECT_NEAR(spread, 1.0, 5.0 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(fourth, 3.0, 5.0 * std::sqrt(96.0 / kDraws));
}

}  // namespace
}  // namespace sinew::pcc
