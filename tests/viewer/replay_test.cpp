// Recorded states are shown as they were: angles of arms, drives, integrators with history.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <future>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/record/run_layout.hpp"
#include "sinew/record/run_recorder.hpp"
#include "sinew/sim/simulation.hpp"

#include "record/older_run.hpp"
#include "robot_fixture.hpp"
#include "viewer/replay_source.hpp"
#include "viewer/robot_state.hpp"

namespace sinew::viewer {
namespace {

constexpr const char* kArm = R"(sinew: 1
time_step: 2 ms
integrator: {type: generalized-alpha, spectral_radius: 0.8}
bodies:
  arm:
    type: pcc
    segments:
      - {length: 140 mm, mass: 190 g, stiffness: 0.108 N m, damping: 0.01 N m s}
      - {length: 140 mm, mass: 90 g, stiffness: 0.108 N m, damping: 0.01 N m s}
actuators:
  bend: {type: torque, body: arm, segment: 1, command: {torque: 0.05 N m}}
  pull: {type: cable, body: arm, points: [10 0 -1 mm, 10 0 -270 mm], command: {tension: 1 N}}
effectors:
  tip: {body: arm, point: 0 0 -280 mm}
)";

// Everything that run.h5 stores of the current state.
RecordedState moment(RobotState& state) {
  RecordedState recorded;
  sim::Observables& list = state.observables();
  list.refresh();
  for (std::size_t k = 0; k < list.list().size(); ++k) {
    if (record::dataset_of(list.list()[k]).empty()) continue;
    const std::span<const double> numbers = list.read(k);
    recorded.values.push_back({k, {numbers.begin(), numbers.end()}});
  }
  recorded.step = state.simulation().steps();
  return recorded;
}

// The values of a recorded observable.
std::vector<double>& numbers_of(RecordedState& recorded, RobotState& state, const char* name) {
  const std::size_t index = state.observables().find(name);
  return std::ranges::find(recorded.values, index, &RecordedState::Value::observable)->numbers;
}

double signal(const RobotState& state, const Frame& frame, std::string_view key) {
  const auto& list = state.description().signals;
  const auto found = std::ranges::find(list, key, &SignalInfo::key);
  return frame.signals.at(static_cast<std::size_t>(found - list.begin()));
}

// The comparison covers everything except timings.
void expect_same_signals(const RobotState& state, const Frame& was, const Frame& seen) {
  const auto& list = state.description().signals;
  ASSERT_EQ(was.signals.size(), list.size());
  ASSERT_EQ(seen.signals.size(), list.size());
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (list[k].group == "time") continue;
    const double a = was.signals[k], b = seen.signals[k];
    EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << list[k].key << " " << a << " " << b;
  }
}

RobotState state_of(const char* text) {
  scene::Robot made = scene::build(scene::parse_scene_text(text, "test", {}));
  auto simulation = std::make_shared<sim::Simulation>(made.model);
  return {std::move(made), std::move(simulation), std::nullopt};
}

/// The notices of a replay, without those about the elements of its robot.
std::vector<Json> notices_of_the_run(const ReplaySource& source) {
  std::vector<Json> result;
  const Json scene = Json::parse(source.description().scene);
  for (const Json& notice : scene["notices"]) {
    if (notice["kind"] != "locking-element") result.push_back(notice);
  }
  return result;
}

TEST(Replay, ShowsAnArmAsItWas) {
  RobotState run = state_of(kArm), replay = state_of(kArm);
  for (int i = 0; i < 50; ++i) run.step();
  replay.show(moment(run));
  const auto was = run.frame({}, 1.0), seen = replay.frame({}, 1.0);
  EXPECT_EQ(was->bodies[0].positions, seen->bodies[0].positions);
  EXPECT_EQ(was->effectors, seen->effectors);
  EXPECT_EQ(was->cables, seen->cables);
  EXPECT_EQ(was->step, seen->step);
  expect_same_signals(run, *was, *seen);
  EXPECT_EQ(signal(replay, *seen, "pull.tension"), 1.0);
  EXPECT_EQ(signal(replay, *seen, "bend.torque_command"), 0.05);
}

constexpr const char* kFall = R"(sinew: 1
time_step: 2 ms
gravity: 0 0 -9.81 m/s^2
integrator: backward-euler
bodies:
  block:
    type: fem
    mesh: {shape: block, length: 20 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}
    material: {model: corotational, young_modulus: 100 kPa, poisson_ratio: 0.4}
    density: 1070 kg/m^3
contacts:
  floor:
    body: block
    surface: {plane: {normal: 0 0.1 1}}
    nodes: {set: z_min}
    friction: 0.5
    motion: {z: {ramp: {to: 2 mm, duration: 0.1 s}}, angle: {ramp: {to: 90 deg, duration: 0.1 s}}, axis: 0 0 1}
  roof:
    body: block
    surface: {sphere: {centre: 10 10 30.5 mm, radius: 10 mm}}
    nodes: {set: z_max}
    friction: 0
)";

TEST(Replay, ShowsContactsAsTheyWere) {
  RobotState run = state_of(kFall), replay = state_of(kFall);
  for (int i = 0; i < 30; ++i) run.step();
  replay.show(moment(run));
  const auto was = run.frame({}, 1.0), seen = replay.frame({}, 1.0);
  ASSERT_EQ(was->contacts.size(), 2U);
  ASSERT_EQ(was->contacts[0].size(), 7U * (1U + 9U));
  EXPECT_EQ(was->contacts, seen->contacts);
  expect_same_signals(run, *was, *seen);
  EXPECT_GT(signal(replay, *seen, "floor.normal_force"), 0.0);
  EXPECT_NEAR(was->contacts[0][2], 0.002 * 30 * 0.002 / 0.1, 1e-9);  // the floor has risen
  RecordedState short_of = moment(run);
  numbers_of(short_of, run, "floor.points.gap").pop_back();
  EXPECT_THROW(replay.show(short_of), Error);
  RecordedState unknown = moment(run);
  numbers_of(unknown, run, "floor.points.state")[0] = 3.0;
  EXPECT_THROW(replay.show(unknown), Error);
}

TEST(Replay, ShowsWhatAControllerDid) {
  const scene::Robot same = robot();
  RobotState run(same, std::make_shared<sim::Simulation>(same.model), same.controller("hold"));
  RobotState replay(same);
  for (int i = 0; i < 20; ++i) run.step();
  replay.show(moment(run));
  const auto was = run.frame({}, 1.0), seen = replay.frame({}, 1.0);
  expect_same_signals(run, *was, *seen);
  EXPECT_EQ(was->targets, seen->targets);
  EXPECT_GT(signal(replay, *seen, "up.tension_command"), 0.0);
  const Json command = Json::parse(replay.status_members())["commands"]["up"];
  EXPECT_EQ(command["quantity"], "tension");
  EXPECT_EQ(command["value"], run.simulation().actuator(0).effort);
}

class Recorded : public ::testing::Test {
 protected:
  Recorded() {
    std::string pattern = (std::filesystem::temp_directory_path() / "sinew_replay_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~Recorded() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

// The notices about what a recording lacks; the scene may have others.
TEST_F(Recorded, RunsAreShownWithWhatWasRecorded) {
  const scene::Robot same = robot();
  sim::Simulation simulation(same.model);
  simulation.command(0, {model::CommandKind::motion, model::Signal::ramp({0.0, 0.002, 0.0, 0.05})});
  record::RecordSettings settings;
  settings.folder = folder_;
  settings.scene = kScene;
  sim::Observables list(simulation);
  std::vector<double> energy;
  {
    record::RunRecorder recorder(sim::Observables(simulation), settings);
    for (int k = 0; k < 10; ++k) {
      simulation.step();
      recorder.after_step();
      list.refresh();
      energy.push_back(list.number(list.find("strain_energy")));
    }
  }
  ReplaySource source(folder_, false, 1.0);
  EXPECT_EQ(source.lacks(), "");
  EXPECT_TRUE(notices_of_the_run(source).empty());
  Watcher watcher;
  source.start(watcher);
  std::promise<void> done;
  source.submit(Seek{3}, [&](const Outcome&) { done.set_value(); });
  done.get_future().wait();
  while (watcher.frame()->step != 3) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const auto frame = watcher.frame();
  const auto& signals = source.description().signals;
  const auto number = [&](std::string_view key) {
    const auto found = std::ranges::find(signals, key, &SignalInfo::key);
    return frame->signals.at(static_cast<std::size_t>(found - signals.begin()));
  };
  EXPECT_DOUBLE_EQ(number("up.displacement_command"), 0.002 * 0.03 / 0.05);
  EXPECT_EQ(number("strain_energy"), energy[2]);

  // The curves of all frames, whichever were shown.
  std::promise<std::string> bytes;
  source.fetch("history.bin",
               [&](std::optional<Download> file) { bytes.set_value(file ? file->bytes : ""); });
  const std::string history = bytes.get_future().get();
  std::array<std::uint32_t, 2> head{};
  ASSERT_GE(history.size(), sizeof(head));
  std::memcpy(head.data(), history.data(), sizeof(head));
  ASSERT_EQ(head[0], 11u) << "the start and ten steps";
  ASSERT_EQ(head[1], signals.size());
  ASSERT_EQ(history.size(), 8 + 11 * (8 + 4 * signals.size()));
  const auto in_history = [&](std::string_view key, std::size_t frame_number) {
    const auto k = static_cast<std::size_t>(std::ranges::find(signals, key, &SignalInfo::key) -
                                            signals.begin());
    float value = 0.0F;
    std::memcpy(&value, history.data() + 8 + 11 * 8 + 4 * (11 * k + frame_number), sizeof(value));
    return value;
  };
  for (std::size_t k = 0; k < 11; ++k) {
    double time = -1.0;
    std::memcpy(&time, history.data() + 8 + 8 * k, sizeof(time));
    EXPECT_NEAR(time, 0.01 * static_cast<double>(k), 1e-12);
    EXPECT_NEAR(in_history("up.displacement_command", k),
                0.002 * std::min(0.01 * static_cast<double>(k) / 0.05, 1.0), 1e-9);
    if (k == 0) continue;
    EXPECT_EQ(in_history("strain_energy", k), static_cast<float>(energy[k - 1]));
  }
  source.stop();
}

TEST_F(Recorded, OlderRunsAreShownAndSayWhatTheyLack) {
  std::string text = kScene;
  text.erase(text.find("probes:"), text.find("controllers:") - text.find("probes:"));
  const scene::Robot same = scene::build(scene::parse_scene_text(text, "test", {}));
  sim::Simulation simulation(same.model);
  {
    record::testing::OlderRun older(folder_ / "run.h5", simulation, text);
    simulation.command(0, {model::CommandKind::effort, model::Signal::constant(0.5)});
    for (int k = 0; k < 5; ++k) {
      simulation.step();
      older.write();
    }
    older.finish();
  }
  ReplaySource source(folder_ / "run.h5", false, 1.0);
  EXPECT_NE(source.lacks().find("recorded without commands"), std::string::npos);
  const std::vector<Json> notices = notices_of_the_run(source);
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices[0]["text"].get<std::string>().find("without commands"), std::string::npos);
  Watcher watcher;
  source.start(watcher);
  while (!watcher.frame()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const auto frame = watcher.frame();
  EXPECT_GT(frame->signals[0], 0.0) << "the tension of the first frame";
  source.stop();
}

TEST(Replay, AnotherArmsAnglesAreRefused) {
  RobotState run = state_of(kArm), replay = state_of(kArm);
  RecordedState recorded = moment(run);
  numbers_of(recorded, run, "arm.coordinates").push_back(0.0);
  EXPECT_THROW(replay.show(recorded), Error);
}

}  // namespace
}  // namespace sinew::viewer
