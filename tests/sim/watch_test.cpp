// Progress callbacks of steps and searches, and cancellation through them.
#include <cmath>

#include <gtest/gtest.h>

#include "sinew/builder/load_settings.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "sim/contact_robots.hpp"
#include "sim/robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::beam;
using sinew::testing::BeamOptions;
using sinew::testing::pull;
using sinew::testing::tension;

struct Ended {};

// Cancels the work at its `calls`th progress callback; returns whether that was reached.
template <class Work>
bool ends_at(Simulation& simulation, int calls, Work&& work) {
  simulation.watch([&calls](const run::StepProgress&) {
    if (--calls == 0) throw Ended{};
  });
  bool ended = false;
  try {
    work();
  } catch (const Ended&) {
    ended = true;
  }
  simulation.watch({});
  return ended;
}

// Cancels a step at its first, second, ... and some later callbacks, until it completes; each time
// the state is restored. The run then continues as without a callback.
void expect_steps_that_can_be_ended(const std::shared_ptr<const model::Model>& model,
                                    model::Command command, int least_calls) {
  Simulation plain(model), ended(model);
  for (Simulation* one : {&plain, &ended}) {
    one->step();
    one->command(0, command);
  }
  const run::State before = ended.state();
  int calls = 1;
  while (ends_at(ended, calls, [&] { ended.step(); })) {
    ASSERT_EQ(ended.state(), before) << calls;
    ASSERT_EQ(ended.steps(), 1);
    calls += 1 + calls / 8;
  }
  EXPECT_GE(calls, least_calls);
  for (int k = 0; k < 3; ++k) {
    if (k > 0) ended.step();
    plain.step();
    EXPECT_EQ(plain.state(), ended.state()) << k;
  }
}

TEST(Watch, AQuasiStaticStepEndsAsIfItHadNotBegun) {
  expect_steps_that_can_be_ended(beam(), pull(0.01), 5);
}

// A soft beam that a cable folds in one step: the search takes parts of the load and descends the
// energy.
BeamOptions soft() {
  BeamOptions options;
  options.young_modulus = 2e4;
  options.friction = 0.2;
  options.step.max_iterations = 5;
  options.step.equilibrium = model::Equilibrium::following;
  return options;
}

TEST(Watch, AStepThatIsApproachedInPartsEndsAsIfItHadNotBegun) {
  expect_steps_that_can_be_ended(beam(soft()), pull(0.03), 30);
}

TEST(Watch, ADynamicStepInHalvesEndsAsIfItHadNotBegun) {
  BeamOptions options;
  options.step.integrator = mechanics::Integrator::bdf2;
  options.step.max_iterations = 4;
  expect_steps_that_can_be_ended(beam(options), pull(0.01), 6);
}

TEST(Watch, AnAdaptiveStepEndsAsIfItHadNotBegun) {
  BeamOptions options;
  options.step.integrator = mechanics::Integrator::bdf2;
  options.step.adaptive = {.tolerance = 1e-4, .smallest = 1e-4};
  expect_steps_that_can_be_ended(beam(options), pull(0.001), 10);
}

TEST(Watch, AStepWithContactsEndsWithinALawToo) {
  BeamOptions options;
  options.wall = -0.012;
  options.gravity = {0.0, 0.0, -9.81};
  options.step.integrator = mechanics::Integrator::backward_euler;
  const auto model = beam(options);
  Simulation simulation(model);
  int within = 0, last = -1;
  simulation.watch([&](const run::StepProgress& step) {
    within += step.iterations == last ? 1 : 0;
    last = step.iterations;
  });
  for (int k = 0; k < 20; ++k) simulation.step();
  EXPECT_GT(within, 0);  // callbacks within a Newton iteration
  simulation.watch({});
  const run::State before = simulation.state();
  Simulation plain(model);
  plain.restore(before);
  for (int calls = 1; ends_at(simulation, calls, [&] { simulation.step(); }); ++calls) {
    ASSERT_EQ(simulation.state(), before) << calls;
  }
  plain.step();
  EXPECT_EQ(simulation.state(), plain.state());
}

TEST(Watch, TheFirstStepOfARunCanBeEndedToo) {
  BeamOptions options;
  options.step.integrator = mechanics::Integrator::bdf2;
  options.gravity = {0.0, 0.0, -9.81};
  for (const bool adaptive : {false, true}) {
    if (adaptive) options.step.adaptive = {.tolerance = 1e-4, .smallest = 1e-4};
    Simulation simulation(beam(options));
    const run::State start = simulation.state();
    EXPECT_TRUE(ends_at(simulation, 2, [&] { simulation.step(); }));
    EXPECT_EQ(simulation.state(), start);
  }
}

TEST(Watch, AStaticSearchEndsAsIfItHadNotBegun) {
  Simulation simulation(beam());
  simulation.step();
  simulation.command(0, tension(2.0));
  const run::State before = simulation.state();
  int calls = 1;
  while (ends_at(simulation, calls, [&] { simulation.solve_static({.max_iterations = 4}); })) {
    ASSERT_EQ(simulation.state(), before) << calls;
    ++calls;
  }
  EXPECT_GT(calls, 10);
}

TEST(Watch, AnEndedPathLeavesItsLastPoint) {
  BeamOptions options;
  Simulation simulation(beam(options));
  simulation.command(0, tension(0.5));
  run::State last;
  int points = 0;
  const bool ended = ends_at(simulation, 8, [&] {
    simulation.follow_path({.largest_step = 0.01}, [&] {
      last = simulation.state();
      ++points;
    });
  });
  EXPECT_TRUE(ended);
  ASSERT_GT(points, 0);
  EXPECT_EQ(simulation.state().bodies, last.bodies);
  EXPECT_EQ(simulation.state().efforts, last.efforts);
}

TEST(Watch, ProgressCountsIterationsAndTime) {
  Simulation simulation(beam(soft()));
  simulation.command(0, pull(0.03));
  int largest = 0;
  bool in_parts = false, in_order = true;
  double seconds = 0.0, residual = 0.0;
  simulation.watch([&](const run::StepProgress& step) {
    in_order = in_order && step.iterations >= largest && step.seconds >= seconds;
    largest = step.iterations;
    seconds = step.seconds;
    residual = step.relative_residual;
    in_parts = in_parts || step.stage == run::SearchStage::parts;
  });
  simulation.step();
  EXPECT_TRUE(in_order);
  EXPECT_TRUE(in_parts);
  EXPECT_EQ(largest, simulation.report().iterations);
  EXPECT_EQ(residual, simulation.report().relative_residual);
  EXPECT_GT(seconds, 0.0);
  EXPECT_LE(seconds, simulation.report().times.total);
}

}  // namespace
}  // namespace sinew::sim
