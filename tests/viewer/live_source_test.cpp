// Running robots as they are shown: steps, clocks, commands, and runs that end before their time.
#include "viewer/live_source.hpp"

#include <condition_variable>
#include <future>
#include <mutex>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"

namespace sinew::viewer {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;

constexpr const char* kScene = R"(sinew: 1
time_step: 10 ms
bodies:
  beam:
    type: fem
    mesh: {shape: block, length: 60 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}
    material: {model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}
    density: 1070 kg/m^3
    fixed: [{set: x_min}]
actuators:
  up:
    type: cable
    body: beam
    points: [0 10 16 mm, 30 10 16 mm, 58 10 16 mm]
    limits: {tension: {min: 0 N, max: 20 N}}
    command: {displacement: 0 mm}
  push: {type: force, body: beam, point: 60 10 10 mm, direction: 1 0 0}
effectors:
  tip: {body: beam, point: 60 10 10 mm}
controllers:
  hold:
    type: inverse
    actuators: [up]
    effectors:
      tip: {target: {polyline: {points: [60 10 10 mm, 60 10 12 mm], period: 1 s}}}
)";

scene::Robot robot() { return scene::build(scene::parse_scene_text(kScene, "test", {})); }

/// Keeps the last frame and status.
class Watcher final : public Publisher {
 public:
  void publish(std::shared_ptr<const Frame> next) override {
    const std::lock_guard lock(mutex_);
    frame_ = std::move(next);
    ++frames_;
  }
  void publish_status(std::string next) override {
    const std::lock_guard lock(mutex_);
    status_ = std::move(next);
  }
  bool wants_field(int field) const override { return field == 2; }
  void replace(std::function<std::unique_ptr<Source>()>) override {}

  std::shared_ptr<const Frame> frame() const {
    const std::lock_guard lock(mutex_);
    return frame_;
  }
  Json status() const {
    const std::lock_guard lock(mutex_);
    return Json::parse(status_);
  }
  int frames() const {
    const std::lock_guard lock(mutex_);
    return frames_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Frame> frame_;
  std::string status_ = "{}";
  int frames_ = 0;
};

/// A source and what it shows.
struct Live {
  explicit Live(const LiveSettings& settings) : source(robot(), settings) { source.start(watcher); }
  ~Live() { source.stop(); }

  Outcome ask(const Request& request) {
    std::promise<Outcome> done;
    source.submit(request, [&](const Outcome& outcome) { done.set_value(outcome); });
    auto answer = done.get_future();
    if (answer.wait_for(60s) != std::future_status::ready) {
      throw std::runtime_error("no answer");
    }
    return answer.get();
  }
  /// The frame of a step, once it is shown.
  std::shared_ptr<const Frame> at(std::uint64_t step) {
    return wait([step](const Frame& frame) { return frame.step == step; });
  }
  template <typename Holds>
  std::shared_ptr<const Frame> wait(Holds&& holds) {
    for (int k = 0; k < 3000; ++k) {
      if (auto frame = watcher.frame(); frame && holds(*frame)) return frame;
      std::this_thread::sleep_for(10ms);
    }
    throw std::runtime_error("no such frame");
  }

  Watcher watcher;
  LiveSource source;
};

std::string kind(const Outcome& outcome) {
  return outcome ? std::string(error_kind_name(outcome->kind())) : "";
}

TEST(LiveSource, StepsExactlyAndAsASimulationDoes) {
  Live live({.controller = "", .playing = false});
  EXPECT_EQ(kind(live.ask(SetCommand{"up", sim::CommandKind::effort, 1.5})), "");
  EXPECT_EQ(kind(live.ask(Step{25})), "");
  const auto frame = live.at(25);
  const scene::Robot same = robot();
  sim::Simulation simulation(same.model);
  simulation.command(0, {sim::CommandKind::effort, sim::Signal::constant(1.5)});
  for (int k = 0; k < 25; ++k) simulation.step();
  EXPECT_EQ(frame->hash, simulation.state_hash());
  EXPECT_EQ(frame->signals[0], simulation.actuator(0).effort);
  EXPECT_FALSE(frame->bodies[0].fields[2].empty()) << "a field that was asked for";
  EXPECT_TRUE(frame->bodies[0].fields[0].empty()) << "a field that nobody asked for";
}

TEST(LiveSource, ResetsBitForBit) {
  Live live({.controller = "hold", .playing = false});
  const auto start = live.at(0)->hash;
  live.ask(Step{30});
  const auto later = live.at(30)->hash;
  EXPECT_NE(later, start);
  live.ask(SetTarget{"tip", Vector3(0.06, 0.012, 0.01)});
  live.ask(Pull{"beam", {0, 1, 2}, Vector3(1, 0, 0), Vector3(0.1, 0, 0.1), 5.0});
  live.ask(ChooseController{std::nullopt});
  live.ask(Step{5});
  EXPECT_EQ(kind(live.ask(Reset{})), "");
  EXPECT_EQ(live.at(0)->hash, start);
  live.ask(Step{30});
  EXPECT_EQ(live.at(30)->hash, later);
}

TEST(LiveSource, PlaysPausesAndKeepsTime) {
  Live live({.controller = "hold", .playing = true, .speed = 0.0});
  live.wait([](const Frame& frame) { return frame.step > 200; });
  EXPECT_EQ(kind(live.ask(Pause{})), "");
  const auto still = live.watcher.frame()->step;
  std::this_thread::sleep_for(200ms);
  EXPECT_LE(live.watcher.frame()->step, still + 500) << "what was under way may yet be shown";
  const auto paused = live.watcher.frame()->step;
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(live.watcher.frame()->step, paused);
  EXPECT_EQ(live.watcher.status()["playing"], false);
}

TEST(LiveSource, RefusesWithAReason) {
  Live live({.controller = "hold", .playing = false});
  EXPECT_EQ(kind(live.ask(SetCommand{"up", sim::CommandKind::motion, 0.0})), "actuator-owned");
  EXPECT_EQ(kind(live.ask(SetCommand{"upp", sim::CommandKind::motion, 0.0})), "unknown-name");
  EXPECT_EQ(kind(live.ask(SetCommand{"up", sim::CommandKind::effort, 21.0})), "out-of-range");
  EXPECT_EQ(kind(live.ask(ChooseController{"hodl"})), "unknown-name");
  EXPECT_EQ(kind(live.ask(SetTarget{"top", Vector3::Zero()})), "unknown-name");
  EXPECT_EQ(kind(live.ask(Pull{"beam", {0, 1, 999999}, Vector3(1, 0, 0), Vector3::Zero(), 1.0})),
            "index-out-of-range");
  EXPECT_EQ(kind(live.ask(Seek{1})), "not-in-this-version");
  EXPECT_EQ(live.watcher.frame()->step, 0U);
}

TEST(LiveSource, SteersWithoutAController) {
  Live live({.controller = "", .playing = false});
  EXPECT_EQ(kind(live.ask(SetTarget{"tip", Vector3(0.06, 0.01, 0.012)})), "");
  live.ask(Step{100});
  live.at(100);
  EXPECT_EQ(live.watcher.status()["controller"], "view");
  EXPECT_EQ(live.watcher.status()["commands"]["up"]["owned"], true);
  EXPECT_EQ(kind(live.ask(SetTarget{"tip", std::nullopt})), "");
  live.ask(Step{1});
  live.at(101);
  EXPECT_EQ(live.watcher.status()["controller"], nullptr);
}

TEST(LiveSource, SaysWhyARunStoppedAndStartsAnew) {
  Live live({.controller = "", .playing = false});
  const auto start = live.at(0)->hash;
  EXPECT_EQ(kind(live.ask(SetCommand{"push", sim::CommandKind::effort, -1e6})), "");
  const Outcome outcome = live.ask(Step{50});
  ASSERT_TRUE(outcome.has_value());
  live.wait([&](const Frame&) { return !live.watcher.status()["stopped"].is_null(); });
  EXPECT_FALSE(live.watcher.status()["stopped"]["message"].get<std::string>().empty());
  EXPECT_EQ(kind(live.ask(Play{})), "diverged");
  EXPECT_EQ(kind(live.ask(Reset{})), "");
  live.wait([&](const Frame& frame) { return frame.hash == start; });
  EXPECT_EQ(kind(live.ask(Step{3})), "");
}

}  // namespace
}  // namespace sinew::viewer
