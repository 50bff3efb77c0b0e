// The forces that hands feel create no energy.
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sinew/high_rate/high_rate_step.hpp"

#include "walls.hpp"

namespace sinew::high_rate {
namespace {

using sinew::testing::kWallStiffness;
using sinew::testing::SeededHand;
using sinew::testing::wall;
using sinew::testing::wall_settings;

struct Felt {
  double created = 0.0;       // J, counted here
  double by_the_step = 0.0;   // J, counted by the step
  double pressing = 0.0;      // s, contact time
  double path = 0.0;          // m^2/s: integral of v^2 during contact
  double mean_damping = 0.0;  // N s/m
};

// A hand whose motion does not depend on the force. The energy is the force, held over a period,
// times the motion.
Felt feel(const HighRateSettings& settings, const auto& hand, double duration) {
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  Snapshot snapshot = wall();
  Felt felt;
  const double period = settings.period;
  const long periods = std::lround(duration / period);
  double before = hand(0.0), force = 0.0;
  for (long k = 0; k <= periods; ++k) {
    const double here = hand(static_cast<double>(k) * period);
    felt.created -= force * (here - before);
    if (force > 0.0) {
      felt.pressing += period;
      felt.path += (here - before) * (here - before) / period;
    }
    input.hands[0] = here;
    force = step.step(k == 0 ? &snapshot : nullptr, input, {}).hands[0];
    before = here;
  }
  felt.by_the_step = step.output().energy_created;
  felt.mean_damping = step.passivity().mean_damping();
  return felt;
}

double sine(double time) { return 10e-3 * std::sin(2.0 * std::numbers::pi * 6.0 * time); }

TEST(Passivity, NoEnergyComesFromAWallInAMinute) {
  const auto expect_passive = [](const auto& hand, const std::string& name) {
    HighRateSettings settings = wall_settings();
    const Felt felt = feel(settings, hand, 60.0);
    settings.passivity.enabled = false;
    const Felt plain = feel(settings, hand, 60.0);
    const double theory = 0.5 * kWallStiffness * settings.period * plain.path;
    RecordProperty(name, fmt::format("created {:.6f} J, without control {:.6f} J, theory {:.6f} J, "
                                     "damping {:.4f} N s/m",
                                     felt.created, plain.created, theory, felt.mean_damping));
    EXPECT_LE(felt.created, 0.0) << name;
    EXPECT_NEAR(felt.by_the_step, felt.created, 1e-9 * plain.created) << name;
    // Colgate & Schenkel: a spring K held for T creates as much energy as a damping of -K T/2.
    EXPECT_NEAR(plain.created, theory, 0.05 * theory) << name;
    EXPECT_GT(theory, 0.01) << name;
  };
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const SeededHand hand(seed);
    expect_passive([&](double time) { return hand.at(time); }, "seed_" + std::to_string(seed));
    // An encoder with a resolution of 10 um.
    expect_passive([&](double time) { return 1e-5 * std::round(1e5 * hand.at(time)); },
                   "encoder_" + std::to_string(seed));
  }
  expect_passive(sine, "sine");
}

TEST(Passivity, AHandAtRestFeelsTheWholeStiffness) {
  const HighRateSettings settings = wall_settings();
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  Snapshot snapshot = wall();
  const SeededHand hand(1);
  for (long k = 0; k <= 5000; ++k) {
    input.hands[0] = hand.at(1e-3 * static_cast<double>(k));
    step.step(k == 0 ? &snapshot : nullptr, input, {});
  }
  for (const double place : {1e-5, 1e-3, 5e-3}) {
    input.hands[0] = place;
    for (int k = 0; k < 3; ++k) step.step(nullptr, input, {});
    EXPECT_NEAR(step.output().hands[0] / place, kWallStiffness, 1e-5 * kWallStiffness);
    EXPECT_EQ(step.output().damping, 0.0);
  }
  input.hands[0] = -1e-9;
  EXPECT_EQ(step.step(nullptr, input, {}).hands[0], 0.0) << "a wall does not pull";
}

// At constant speed the damping is K T/2 once the reserve is full.
TEST(Passivity, DampingIsThatOfTheoryAtConstantSpeed) {
  const HighRateSettings settings = wall_settings();
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  Snapshot snapshot = wall();
  const double speed = 0.05;  // m/s
  for (int k = 0; k < 100; ++k) {
    input.hands[0] = speed * 1e-3 * k;
    step.step(k == 0 ? &snapshot : nullptr, input, {});
  }
  const double theory = 0.5 * kWallStiffness * settings.period;
  EXPECT_NEAR(step.output().damping, theory, 1e-6 * theory);
  EXPECT_NEAR(step.output().hands[0], kWallStiffness * input.hands[0] + theory * speed, 1e-6);
}

TEST(Passivity, DampingHasALimit) {
  HighRateSettings settings = wall_settings();
  settings.passivity = {.reserve = 100.0, .damping_limit = 3.0};
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  Snapshot snapshot = wall();
  for (int k = 0; k < 100; ++k) {
    input.hands[0] = 1e-4 * k;
    step.step(k == 0 ? &snapshot : nullptr, input, {});
    EXPECT_LE(step.output().damping, 3.0 * 0.5 * kWallStiffness * settings.period * (1.0 + 1e-9));
  }
}

}  // namespace
}  // namespace sinew::high_rate
