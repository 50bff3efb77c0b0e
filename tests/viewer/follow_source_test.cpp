// A script makes the steps and the page follows: order of turns, and what the page may do.
#include "viewer/follow_source.hpp"

#include <atomic>
#include <future>
#include <thread>

#include <gtest/gtest.h>

#include "sinew/control/target_controller.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "robot_fixture.hpp"

namespace sinew::viewer {
namespace {

using namespace std::chrono_literals;

/// A script with its simulation and view.
struct Script {
  explicit Script(bool playing, double speed = 0.0)
      : shown(robot()),
        simulation(std::make_shared<sim::Simulation>(shown.model)),
        source(shown, simulation,
               {.controller = "", .playing = playing, .speed = speed, .gallery = {}}) {
    source.start(watcher);
    while (!source.wait_turn(100ms)) {
    }
  }
  ~Script() { source.stop(); }

  /// Runs one turn of the source; false if the source has ended.
  bool update() {
    source.hand_over();
    while (!source.wait_turn(10ms)) {
    }
    return !source.ended();
  }
  std::future<Outcome> ask(const Request& request) {
    auto done = std::make_shared<std::promise<Outcome>>();
    auto answer = done->get_future();
    source.submit(request, [done](const Outcome& outcome) { done->set_value(outcome); });
    return answer;
  }

  Watcher watcher;
  scene::Robot shown;
  std::shared_ptr<sim::Simulation> simulation;
  FollowSource source;
};

TEST(FollowSource, ShowsWhatTheScriptDid) {
  Script script(true);
  EXPECT_EQ(script.watcher.frame()->step, 0U) << "a first frame before the first step";
  for (int k = 0; k < 20; ++k) {
    script.simulation->step();
    ASSERT_TRUE(script.update());
  }
  // There are at most 60 frames per second; the last one is sent when the script pauses.
  std::this_thread::sleep_for(30ms);
  script.simulation->step();
  ASSERT_TRUE(script.update());
  ASSERT_TRUE(script.update());
  EXPECT_EQ(script.watcher.frame()->step, 21U);
  EXPECT_EQ(script.watcher.frame()->hash, script.simulation->state().hash());
}

TEST(FollowSource, CarriesOutRequestsInTurnsOnly) {
  Script script(true);
  auto answer = script.ask(SetCommand{"up", "tension", 0.5});
  EXPECT_EQ(answer.wait_for(50ms), std::future_status::timeout) << "the script has its turn";
  ASSERT_TRUE(script.update());
  EXPECT_EQ(kind(answer.get()), "");
  EXPECT_EQ(script.simulation->actuator(0).command.signal.value(0.0), 0.5);
  auto reset = script.ask(Reset{});
  auto target = script.ask(SetTarget{"tip", Vector3(0.06, 0.01, 0.012)});
  auto controller = script.ask(ChooseController{"hold"});
  ASSERT_TRUE(script.update());
  EXPECT_EQ(kind(reset.get()), "not-in-this-version");
  EXPECT_EQ(kind(target.get()), "no-effectors");
  EXPECT_EQ(kind(controller.get()), "not-in-this-version");
  const auto own =
      control::make_controller(*script.simulation, script.shown.controllers.at(0).settings);
  script.source.observe("own", own.get());
  auto steered = script.ask(SetTarget{"tip", Vector3(0.06, 0.01, 0.012)});
  ASSERT_TRUE(script.update());
  EXPECT_EQ(kind(steered.get()), "");
  EXPECT_EQ(own->settings().tasks.at(0).target.at(0.0).z(), 0.012);
  script.source.observe({}, nullptr);
}

TEST(FollowSource, APauseHoldsTheScriptAndStepsLetItGoOn) {
  Script script(false);
  std::atomic<int> turns{0};
  std::thread runner([&] {
    while (script.update()) {
      script.simulation->step();
      ++turns;
    }
  });
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(turns, 0);
  auto step = script.ask(Step{5});
  EXPECT_EQ(kind(step.get()), "");
  for (int k = 0; k < 500 && turns < 5; ++k) std::this_thread::sleep_for(10ms);
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(turns, 5);
  script.source.stop();
  runner.join();
  EXPECT_EQ(script.simulation->steps(), turns);
}

}  // namespace
}  // namespace sinew::viewer
