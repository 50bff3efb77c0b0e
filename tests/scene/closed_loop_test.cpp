// Closed loops in scenes: decay of errors, effect of delays and silent sensors, and invalid scenes.
#include "sinew/control/closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/control/inverse_controller.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/run/state.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sense/channel.hpp"
#include "sinew/sense/sensors.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::scene::closed_loop {
namespace {

using control::ControllerStatus;

// A finger held by four taut cables, initially in equilibrium.
const std::string kFinger = R"(sinew: 1
time_step: 10 ms
integrator: quasi-static
bodies:
  finger:
    type: fem
    mesh: {shape: cylinder, radius: 10 mm, height: 80 mm, element_size: 10 mm}
    material: {young_modulus: 400 kPa, poisson_ratio: 0.4}
    mass: 30 g
    fixed: {set: bottom}
actuators:
  east: {type: cable, body: finger, points: [6 0 0 mm, 6 0 40 mm, 6 0 75 mm], command: {tension: 3 N}}
  north: {type: cable, body: finger, points: [0 6 0 mm, 0 6 40 mm, 0 6 75 mm], command: {tension: 3 N}}
  west: {type: cable, body: finger, points: [-6 0 0 mm, -6 0 40 mm, -6 0 75 mm], command: {tension: 3 N}}
  south: {type: cable, body: finger, points: [0 -6 0 mm, 0 -6 40 mm, 0 -6 75 mm], command: {tension: 3 N}}
effectors:
  tip: {body: finger, point: 0 0 80 mm}
)";

std::string with_sensor(const std::string& channel = "") {
  return kFinger + "sensors:\n  tip: {type: marker, body: finger, point: 0 0 80 mm" + channel +
         "}\n";
}

std::string with_limits(const std::string& limits) {
  std::string text = with_sensor();
  for (std::size_t at = text.find("command:"); at != std::string::npos;
       at = text.find("command:", at + limits.size() + 1)) {
    text.insert(at, limits);
  }
  return text;
}

std::unique_ptr<control::TargetController> closed_loop(sim::Simulation& simulation,
                                                       control::TargetSettings settings,
                                                       control::ClosedLoopSettings own) {
  return std::make_unique<control::ClosedLoop>(simulation, std::move(settings), std::move(own));
}

struct Trial {
  explicit Trial(const std::string& text, int threads = 1)
      : robot(build(parse_scene_text(text, "scene.yaml", {}))),
        simulation(std::make_unique<sim::Simulation>(robot.model, threads)) {
    simulation->solve_static();
  }
  void attach(double gain, const Vector3& way, double integral = 0.0) {
    target = tip() + way;
    control::TargetSettings settings{
        .tasks = {{0, control::Target::fixed(target), {1.0, 1.0, 0.0}}},
        .actuators = {},
        .tolerance = 1e-6};
    loop = closed_loop(*simulation, std::move(settings),
                       {.sensors = {0}, .gain = gain, .integral = integral});
  }
  Vector3 tip() const { return simulation->effector_value(0); }
  // Error in the directions with non-zero weight, m.
  double error() const { return (tip() - target).head<2>().norm(); }
  std::vector<double> errors(int steps) {
    std::vector<double> all;
    for (int k = 0; k < steps; ++k) {
      simulation->step();
      all.push_back(error());
    }
    return all;
  }

  Robot robot;
  std::unique_ptr<sim::Simulation> simulation;
  std::unique_ptr<control::TargetController> loop;
  Vector3 target = Vector3::Zero();
};

TEST(ClosedLoop, ErrorsFallAsThoseOfFirstOrder) {
  Trial run(with_sensor());
  run.attach(10.0, {1e-4, 1e-4, 0.0});
  const double start = run.error();
  const std::vector<double> errors = run.errors(20);
  for (std::size_t k = 0; k < errors.size(); ++k) {
    EXPECT_NEAR(errors[k], start * std::pow(0.9, static_cast<double>(k + 1)), 0.01 * start) << k;
  }
  EXPECT_EQ(run.loop->status(), ControllerStatus::moving);
  run.errors(60);
  EXPECT_EQ(run.loop->status(), ControllerStatus::on_target);
  // Both are differences of positions of 80 mm, taken in another order.
  EXPECT_NEAR(run.loop->measured_error(0), run.loop->error(0), 1e-16)
      << "an exact sensor without delay";
}

// Without prediction, a delay of three samples allows a gain up to 0.445/T; with it 2/T, as without
// delay.
TEST(ClosedLoop, ADelayIsMadeUpFor) {
  for (const char* late : {", delay: 30 ms", ", delay: 20 ms, rate: 50 Hz"}) {
    Trial run(with_sensor(late));
    run.attach(150.0, {2e-5, 0.0, 0.0});
    const double start = run.error();
    const std::vector<double> errors = run.errors(25);
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(errors[static_cast<std::size_t>(k)], start * std::pow(0.5, k + 1), 0.03 * start);
    }
    EXPECT_LT(errors.back(), 1e-3 * start) << late;
  }
}

std::string push(const std::string& factor) {
  return "loads:\n  hand: {type: force, body: finger, point: 0 0 80 mm, force: 0.1 0 0 N, "
         "factor: " +
         factor + "}\n";
}

// A push is visible only in the samples, so its step is not predicted.
TEST(ClosedLoop, APushIsFeltBeforeItIsAnswered) {
  const std::string scene = with_sensor() + push("{steps: [[0 s, 0], [45 ms, 1]]}");
  Trial run(scene);
  run.attach(10.0, Vector3::Zero());
  EXPECT_LT(run.errors(4).back(), 1e-8) << "cables that relax against each other move it";
  const std::vector<double> errors = run.errors(15);
  EXPECT_GT(errors[0], 1e-4);
  for (std::size_t k = 1; k < errors.size(); ++k) {
    EXPECT_NEAR(errors[k] / errors[k - 1], 0.9, 0.01) << k;
  }
}

// A disturbance of d m/s leaves the error d/gain. With an integral, only its rate of change divided
// by the integral gain remains, since the finger stiffens as it bends. The cables stay taut; d
// jumps if one becomes slack.
TEST(ClosedLoop, AnIntegralFollowsWhatGrows) {
  const std::string scene =
      with_limits("limits: {tension: {min: 1 N}}, ") + push("{ramp: {to: 1, duration: 4 s}}");
  const auto left = [&](double gain, double integral) {
    Trial run(scene);
    run.attach(gain, Vector3::Zero(), integral);
    const std::vector<double> errors = run.errors(350);
    return *std::max_element(errors.end() - 50, errors.end());
  };
  const double slow = left(5.0, 0.0);
  EXPECT_GT(slow, 1e-5);
  EXPECT_NEAR(left(10.0, 0.0) / slow, 0.5, 0.03);
  EXPECT_LT(left(5.0, 6.25), 0.05 * slow);
}

TEST(ClosedLoop, TurnsWhatAnOrientationMeasures) {
  std::string text = kFinger;
  text.replace(text.find("tip: {body: finger, point: 0 0 80 mm}"), 37,
               "tip: {body: finger, orientation: [0 0 80 mm, 5 0 80 mm, 0 5 80 mm]}");
  Trial run(text +
            "sensors:\n  turn: {type: orientation, body: finger, at: [0 0 80 mm, 5 0 80 mm, 0 "
            "5 80 mm]}\n");
  const Vector3 way(0.03, -0.02, 0.0);
  control::TargetSettings settings;
  settings.tasks = {{0, control::Target::fixed(run.tip() + way), {1.0, 1.0, 0.0}}};
  run.loop = closed_loop(*run.simulation, settings, {.sensors = {0}, .gain = 20.0});
  for (int k = 0; k < 40; ++k) run.simulation->step();
  EXPECT_LT(run.loop->error(0), 1e-4);
  EXPECT_LT((run.tip() - settings.tasks[0].target.at(0.0)).head<2>().norm(), 1e-3);
}

TEST(ClosedLoop, HoldsWhileASensorIsSilent) {
  Trial run(with_sensor());
  run.attach(10.0, {1e-3, 0.0, 0.0});
  const Vector3 seen = run.tip();
  sense::sensors_of(*run.simulation).feed(0, 0.0, {seen.data(), 3});
  std::vector<ControllerStatus> statuses;
  for (int k = 0; k < 14; ++k) {
    run.simulation->step();
    statuses.push_back(run.loop->status());
  }
  // The sample taken at 0 s is used from 0 to 100 ms, and no later.
  EXPECT_EQ(std::ranges::count(statuses, ControllerStatus::moving), 11);
  EXPECT_EQ(statuses[11], ControllerStatus::holding);
  EXPECT_THAT(run.loop->conflict(), testing::HasSubstr("'tip' is silent for 0.1"));
  const double command = run.simulation->actuator(0).command.signal.value(0.0);
  const Vector3 held = run.tip();
  run.simulation->step();
  EXPECT_EQ(run.simulation->actuator(0).command.signal.value(0.0), command);
  EXPECT_LT((run.tip() - held).norm(), 1e-9);
  const Vector3 now = run.tip();
  sense::sensors_of(*run.simulation).feed(0, run.simulation->time(), {now.data(), 3});
  run.simulation->step();
  EXPECT_EQ(run.loop->status(), ControllerStatus::moving);
  EXPECT_TRUE(run.loop->conflict().empty());
}

TEST(ClosedLoop, LeavesTheScenesCommandsUntilTheFirstSample) {
  Robot robot = build(parse_scene_text(with_sensor(", delay: 50 ms"), "scene.yaml", {}));
  sim::Simulation simulation(robot.model);
  control::TargetSettings settings;
  settings.tasks = {{0, control::Target::fixed({0.005, 0.0, 0.08}), {1.0}}};
  const auto loop = closed_loop(simulation, settings, {.sensors = {0}});
  for (int k = 0; k < 5; ++k) simulation.step();
  EXPECT_EQ(loop->status(), ControllerStatus::holding);
  EXPECT_THAT(loop->conflict(), testing::HasSubstr("'tip' has delivered nothing yet"));
  EXPECT_DOUBLE_EQ(simulation.actuator(0).effort, 3.0);
  simulation.step();
  EXPECT_EQ(loop->status(), ControllerStatus::moving);
  EXPECT_EQ(simulation.actuator(0).command.kind, model::CommandKind::motion);
  simulation.reset();
  EXPECT_EQ(loop->status(), ControllerStatus::not_started);
  EXPECT_EQ(simulation.actuator(0).command.kind, model::CommandKind::effort);
}

TEST(ClosedLoop, SaysThatLimitsHoldEffectorsBack) {
  Trial run(with_limits("limits: {tension: {max: 4 N}, displacement: {rate: 50 mm/s}}, "));
  run.attach(10.0, {0.03, 0.0, 0.0});
  run.errors(60);
  EXPECT_EQ(run.loop->status(), ControllerStatus::at_limits);
  for (int k = 0; k < 4; ++k) EXPECT_LT(run.simulation->actuator(k).effort, 4.02);
}

// The state contains everything that determines how a run continues.
TEST(ClosedLoop, GoesOnBitForBit) {
  const std::string scene = with_sensor(", noise: 0.1 mm, delay: 25 ms, rate: 50 Hz, seed: 3");
  const auto attach = [](sim::Simulation& simulation) {
    control::TargetSettings settings;
    settings.tasks = {
        {0, control::Target::circle({.centre = {0.0, 0.0, 0.078}, .radius = 0.004}), {1.0}}};
    return closed_loop(simulation, settings, {.sensors = {0}, .gain = 8.0, .integral = 5.0});
  };
  Trial run(scene);
  run.loop = attach(*run.simulation);
  run.errors(15);
  const run::State kept = run.simulation->state();
  const auto copy = run.simulation->clone();
  const auto other = attach(*copy);
  copy->restore(kept);
  EXPECT_EQ(copy->state(), kept);
  Trial threads(scene, 3);
  threads.loop = attach(*threads.simulation);
  threads.errors(15);
  EXPECT_EQ(threads.simulation->state(), kept) << "three threads";
  run.errors(10);
  const run::State whole = run.simulation->state();
  for (int k = 0; k < 10; ++k) copy->step();
  EXPECT_EQ(copy->state(), whole);
  EXPECT_EQ(other->status(), run.loop->status());
  run.simulation->restore(kept);
  run.errors(10);
  EXPECT_EQ(run.simulation->state(), whole);
  run.simulation->reset();
  EXPECT_EQ(run.loop->status(), ControllerStatus::not_started);
}

// An interrupted step does not change the loop.
TEST(ClosedLoop, AFailedStepChangesNothing) {
  Trial run(with_sensor());
  run.attach(10.0, {1e-3, 5e-4, 0.0}, 5.0);
  run.errors(5);
  const run::State before = run.simulation->state();
  const auto command = [&] { return run.simulation->actuator(0).command.signal.value(0.0); };
  const std::vector<double> told{command()};
  struct Ended {};
  run.simulation->watch([](const run::StepProgress&) { throw Ended{}; });
  try {
    run.simulation->step();
    FAIL() << "the step went on";
  } catch (const Ended&) {
  }
  EXPECT_EQ(run.simulation->state(), before);
  EXPECT_EQ(command(), told.front());
}

TEST(ClosedLoop, OwnsItsActuators) {
  Trial run(with_sensor());
  run.attach(10.0, {1e-3, 0.0, 0.0});
  run.errors(5);
  const model::Command other{model::CommandKind::effort, model::Signal::constant(1.0)};
  EXPECT_THROW(run.simulation->command(0, other), Error);
  control::TargetSettings second;
  second.tasks = {{0, control::Target::fixed(run.tip()), {1.0}}};
  EXPECT_THROW(control::InverseController(*run.simulation, second), Error);
  const double command = run.simulation->actuator(0).command.signal.value(0.0);
  run.loop->detach();
  run.simulation->step();
  EXPECT_NEAR(run.simulation->actuator(0).motion, command, 1e-12)
      << "it stays where it was told to be";
  run.simulation->command(0, other);
  run.simulation->step();
  EXPECT_NEAR(run.simulation->actuator(0).effort, 1.0, 1e-9);
}

// Scene files.

std::string hold(const std::string& keys, const std::string& sensors = "[tip]") {
  return "controllers:\n  hold: {type: closed-loop, sensors: " + sensors + ", " + keys + "}\n";
}
const std::string kTask = "effectors: {tip: {target: 3 2 78 mm}}";

TEST(ClosedLoopScene, IsBuiltAndSteers) {
  const std::string text = with_sensor(", noise: 0.1 mm, rate: 100 Hz, delay: 20 ms, seed: 1") +
                           hold(kTask + ", gain: 8 1/s, integral: 16 1/s^2, timeout: 50 ms");
  Trial run(text);
  ASSERT_EQ(run.robot.controllers.size(), 1U);
  run.loop = control::make_controller(*run.simulation, run.robot.controllers[0].settings);
  const auto* loop = dynamic_cast<const control::ClosedLoop*>(run.loop.get());
  ASSERT_NE(loop, nullptr);
  EXPECT_EQ(loop->own_settings().gain, 8.0);
  EXPECT_EQ(loop->own_settings().integral, 16.0);
  EXPECT_EQ(loop->own_settings().timeout, 0.05);
  EXPECT_EQ(loop->own_settings().sensors, std::vector<int>{0});
  for (int k = 0; k < 250; ++k) run.simulation->step();
  double sum = 0.0;
  for (int k = 0; k < 50; ++k) {
    run.simulation->step();
    sum += run.loop->error();
  }
  EXPECT_LT(sum / 50.0, 1e-4) << "0.1 mm of noise, filtered by the loop";
  EXPECT_EQ(run.loop->status(), ControllerStatus::on_target);
}

struct Wrong {
  const char* name;
  std::string text;
  ErrorKind kind;
  int line;
  const char* message;
  const char* remedy;
};
void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }

class WrongLoops : public testing::TestWithParam<Wrong> {};

TEST_P(WrongLoops, AreRefusedWithPlaceAndRemedy) {
  const Wrong& wrong = GetParam();
  try {
    build(parse_scene_text(wrong.text, "scene.yaml", {}));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error_kind_name(error.kind()), error_kind_name(wrong.kind)) << error.what();
    EXPECT_EQ(error.place().line, wrong.line) << error.what();
    EXPECT_THAT(error.message(), testing::HasSubstr(wrong.message));
    EXPECT_THAT(error.remedy(), testing::HasSubstr(wrong.remedy));
  }
}

const std::string kLength = "  length: {type: cable-length, actuator: east}\n";
const std::string kElsewhere = "  low: {type: marker, body: finger, point: 0 0 60 mm}\n";
const std::string kAgain = "  twin: {type: marker, body: finger, point: 0 0 80 mm}\n";

std::string with_stone() {
  std::string text = with_sensor();
  text.insert(
      text.find("actuators:"),
      "  stone: {type: rigid, shape: {box: 10 10 10 mm}, mass: 10 g, fixed: true, pose: {position: "
      "100 0 0 mm}}\n");
  text.insert(text.find("sensors:"), "  far: {body: stone, point: 100 0 0 mm}\n");
  return text + "  far: {type: marker, body: stone, point: 100 0 0 mm}\n" +
         hold("effectors: {far: {target: 100 0 1 mm}}", "[far]");
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, WrongLoops,
    testing::Values(Wrong{"unknown_sensor", with_sensor() + hold(kTask, "[top]"),
                          ErrorKind::unknown_name, 21, "'top' is not under `sensors`", "tip"},
                    Wrong{"wrong_type", with_sensor() + kLength + hold(kTask, "[tip, length]"),
                          ErrorKind::wrong_type, 22, "'length' is of type cable-length", "marker"},
                    Wrong{"elsewhere", with_sensor() + kElsewhere + hold(kTask, "[low]"),
                          ErrorKind::conflicting_keys, 22, "'low' measures none",
                          "{type: marker, body: finger, point: 0 0 80 mm}"},
                    Wrong{"twice", with_sensor() + kAgain + hold(kTask, "[tip, twin]"),
                          ErrorKind::duplicate_key, 22, "measure the same effector", "name one"},
                    Wrong{"rate", with_sensor(", rate: 5 Hz") + hold(kTask),
                          ErrorKind::out_of_range, 21, "every 0.2 s", "longer timeout"},
                    Wrong{"gain", with_sensor() + hold(kTask + ", gain: 0 1/s"),
                          ErrorKind::out_of_range, 21, "", "above 0"},
                    Wrong{"no_sensors",
                          with_sensor() + "controllers:\n  hold: {type: closed-loop, " + kTask +
                              "}\n",
                          ErrorKind::missing_key, 21, "sensors", ""},
                    Wrong{"unreached", with_stone(), ErrorKind::no_actuators, 24,
                          "no actuator of 'hold' moves the body 'stone'", "actuator of this body"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sinew::scene::closed_loop
