// Steps that end without a solution stop the run at the last solved state, unless told to go on.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state_io.hpp"
#include "sinew/world/world.hpp"

#include "arches.hpp"
#include "chambers.hpp"
#include "robots.hpp"
#include "support/error_kind.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::chamber;
using sinew::testing::ChamberOptions;
using sinew::testing::kind_of;
using sinew::testing::kVoid;

// The neo-Hookean wall (mu = 30 kPa) bears no more than about 1.5 mu.
constexpr double kTooMuch = 100e3;

model::Command pressure(const model::Signal& signal) {
  return {model::CommandKind::effort, signal};
}

model::Command ramp(double to, int steps, double time_step) {
  return pressure(model::Signal::ramp({0.0, to, 0.0, steps * time_step}));
}

// Steps until one fails. @return its message; empty if none of `most` fails.
std::string run_until_failure(Simulation& simulation, int most) {
  for (int k = 0; k < most; ++k) {
    try {
      simulation.step();
    } catch (const Error& failure) {
      EXPECT_TRUE(failure.is_run_failure());
      return failure.what();
    }
    EXPECT_EQ(simulation.report().status, run::StepStatus::solved) << k;
    EXPECT_FALSE(is_failure(simulation.report().status)) << k;
  }
  return {};
}

TEST(FailedStep, APressureBeyondItsPeakStopsAtTheLastEquilibrium) {
  for (const int steps : {1, 4, 25}) {
    Simulation simulation(chamber());
    simulation.command(0, ramp(kTooMuch, steps, simulation.model().step().time_step));
    const std::string text = run_until_failure(simulation, steps);
    EXPECT_NE(text.find("limit point"), std::string::npos) << steps << ": " << text;
    EXPECT_NE(text.find("volume_growth"), std::string::npos) << text;
    EXPECT_NE(text.find("chamber 'chamber'"), std::string::npos) << text;
    EXPECT_TRUE(is_failure(simulation.report().status));
    // The state is that of the last solved step: of the command before, at a sane size.
    const double reached = kTooMuch * static_cast<double>(simulation.steps()) / steps;
    EXPECT_NEAR(simulation.actuator(0).effort, reached, 1e-9 * kTooMuch);
    EXPECT_LT(simulation.actuator(0).motion, 50.0 * kVoid);
    EXPECT_EQ(simulation.state().failed, 0.0);
    // A smaller command works from there.
    simulation.command(0, pressure(model::Signal::constant(5e3)));
    EXPECT_EQ(simulation.step().status, run::StepStatus::solved);
    Simulation other(simulation.shared_model());
    other.command(0, pressure(model::Signal::constant(5e3)));
    other.solve_static();
    EXPECT_NEAR(simulation.actuator(0).motion, other.actuator(0).motion, 1e-3 * kVoid);
  }
}

TEST(FailedStep, NothingThatDescendsFromOneIsSolved) {
  Simulation simulation(chamber());
  const double time_step = simulation.model().step().time_step;
  simulation.command(0, ramp(kTooMuch, 10, time_step));
  int failed = 0;
  for (int k = 0; k < 12; ++k) {
    try {
      const run::StepStatus status = simulation.step(OnFailure::keep_going).status;
      failed += is_failure(status) ? 1 : 0;
      EXPECT_EQ(status == run::StepStatus::solved, failed == 0) << k;
    } catch (const Error& failure) {  // of a state that cannot be evaluated
      EXPECT_TRUE(failure.is_run_failure());
      break;
    }
  }
  ASSERT_GT(failed, 0);
  EXPECT_EQ(simulation.state().failed, 1.0);
  // The mark is part of the state: it is copied, saved and restored.
  const std::string saved = format_state(simulation);
  Simulation copy(simulation.shared_model());
  parse_state(copy, saved, "saved");
  EXPECT_EQ(copy.state(), simulation.state());
  copy.command(0, pressure(model::Signal::constant(1e3)));
  try {
    EXPECT_GE(copy.step(OnFailure::keep_going).status, run::StepStatus::after_failure);
  } catch (const Error& failure) {
    EXPECT_TRUE(failure.is_run_failure());
  }
  copy.reset();
  copy.command(0, pressure(model::Signal::constant(1e3)));
  EXPECT_EQ(copy.step().status, run::StepStatus::solved);
}

TEST(FailedStep, AVacuumThatCollapsesTheWallStops) {
  ChamberOptions options;
  Simulation simulation(chamber(options));
  simulation.command(0, ramp(-100e3, 10, simulation.model().step().time_step));
  const std::string text = run_until_failure(simulation, 10);
  // Whether the wall bears it or not, the chamber keeps a positive volume.
  EXPECT_GT(simulation.actuator(0).motion + kVoid, 0.0) << text;
  EXPECT_GT(simulation.report().smallest_volume_ratio, 0.0);
}

TEST(FailedStep, TheVolumeRatioIsThatOfTheState) {
  Simulation simulation(chamber());
  simulation.command(0, pressure(model::Signal::constant(10e3)));
  const double moved = simulation.step().smallest_volume_ratio;
  EXPECT_LT(moved, 1.0);
  // A step that has nothing to do reports the same.
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(simulation.step().smallest_volume_ratio, moved, 0.02) << k;
  }
  EXPECT_EQ(simulation.report().smallest_volume_ratio,
            simulation.world().bodies().smallest_volume().ratio);
}

TEST(Vacuum, NoCommandGoesBelowIt) {
  Simulation simulation(chamber());
  for (const model::Signal& signal :
       {model::Signal::constant(-150e3), model::Signal::ramp({0.0, -150e3, 0.0, 1.0}),
        model::Signal::sine({0.0, 150e3, 1.0, 0.0}),
        model::Signal::steps({{0.0, 0.0}, {1.0, -102e3}}),
        model::Signal::sampled({0.0, 1.0, 2.0}, {0.0, -102e3, 0.0})}) {
    EXPECT_EQ(kind_of([&] { simulation.command(0, pressure(signal)); }), ErrorKind::out_of_range);
  }
  simulation.command(0, pressure(model::Signal::constant(-101325.0)));
  ChamberOptions options;
  options.gas = model::GasSettings{.ambient_pressure = 2e5};
  Simulation deep(chamber(options));
  deep.command(0, pressure(model::Signal::constant(-150e3)));
  EXPECT_EQ(kind_of([&] { deep.command(0, pressure(model::Signal::constant(-201e3))); }),
            ErrorKind::out_of_range);
  EXPECT_EQ(deep.model().actuators()[0].effort.min, -2e5);
}

TEST(Vacuum, AVolumeThatNeedsLessCavitates) {
  Simulation simulation(chamber());
  double lowest = 0.0;
  bool cavitates = false;
  for (int k = 1; k <= 19 && !cavitates; ++k) {
    simulation.command(0, sinew::testing::pull(-0.05 * k * kVoid));
    try {
      cavitates = simulation.step().status == run::StepStatus::cavitates;
    } catch (const Error&) {
      break;
    }
    lowest = simulation.actuator(0).effort;
    EXPECT_EQ(cavitates, lowest < -101325.0) << k;
  }
  EXPECT_LT(lowest, 0.0);
}

// Under a growing force, the arch leaves its branch in one step; a commanded motion leads it
// through the same states without a jump.
TEST(Snapped, AnArchThatSnapsThroughSaysSo) {
  for (const bool by_force : {true, false}) {
    Simulation simulation(sinew::testing::arch({.by_load = false}));
    const double top = simulation.effector_value(0).z();
    double before = 0.0;
    int snapped = 0;
    for (int k = 1; k <= 40; ++k) {
      simulation.command(
          0, by_force ? sinew::testing::tension(5e-4 * k) : sinew::testing::pull(4e-4 * k));
      const run::StepReport& report = simulation.step();
      const double depth = top - simulation.effector_value(0).z();
      EXPECT_EQ(report.status, run::StepStatus::solved) << k;
      EXPECT_EQ(report.snapped, depth - before > 4e-3) << by_force << " " << k << " " << depth;
      snapped += report.snapped ? 1 : 0;
      before = depth;
    }
    EXPECT_EQ(snapped, by_force ? 1 : 0);
  }
}

}  // namespace
}  // namespace sinew::sim
