// Going back in a run and continuing from there, bit for bit and with bounded memory.
#include "viewer/timeline.hpp"

#include <future>
#include <thread>

#include <gtest/gtest.h>

#include "sinew/sim/simulation.hpp"

#include "robot_fixture.hpp"
#include "viewer/limits.hpp"
#include "viewer/live_source.hpp"
#include "viewer/real_time_factor.hpp"
#include "viewer/robot_state.hpp"

namespace sinew::viewer {
namespace {

using namespace std::chrono_literals;

Moment moment_at(std::int64_t step, std::size_t numbers = 4) {
  Moment moment;
  moment.state.efforts.resize(numbers);
  moment.state.steps = step;
  moment.time = 0.05 * static_cast<double>(step);
  return moment;
}

TEST(Timeline, ForgetsWhatIsTooOldOrTakesTooMuch) {
  Timeline timeline;
  for (int step = 0; step <= 2000; ++step) timeline.keep(moment_at(step));
  const TimelineFrame shown = timeline.describe(100.0);
  EXPECT_EQ(shown.latest, 2000);
  EXPECT_EQ(shown.shown, 2000);
  EXPECT_NEAR(shown.latest_time - shown.oldest_time, limits::kTimelineSeconds, 0.051);
  constexpr std::size_t kNumbers = std::size_t{1} << 20;  // 8 MiB per moment
  timeline.clear();
  for (int step = 0; step < 40; ++step) timeline.keep(moment_at(step, kNumbers));
  EXPECT_LE(timeline.bytes(), limits::kTimelineBytes);
  EXPECT_EQ(timeline.size(), 15U) << "of 8 MiB and a few numbers in 128 MiB";
  EXPECT_EQ(timeline.go_back(0).state.steps, 25) << "the oldest that is kept";
}

TEST(Timeline, DropsAFutureThatARunHasLeft) {
  Timeline timeline;
  EXPECT_TRUE(timeline.due(0.0));
  for (int step = 0; step < 10; ++step) timeline.keep(moment_at(step));
  EXPECT_FALSE(timeline.due(0.45 + 0.03));
  EXPECT_TRUE(timeline.due(0.45 + 0.034));
  EXPECT_EQ(timeline.go_back(3).state.steps, 3);
  EXPECT_TRUE(timeline.in_past());
  EXPECT_EQ(timeline.go_back(9).state.steps, 9) << "and forward again";
  EXPECT_FALSE(timeline.in_past());
  timeline.go_back(4);
  timeline.go_on();
  EXPECT_EQ(timeline.describe(0.2).latest, 4);
  timeline.keep(moment_at(4, 8));
  EXPECT_EQ(timeline.size(), 5U) << "one moment a step";
  EXPECT_EQ(timeline.go_back(4).state.efforts.size(), 8U);
}

/// The hashes of a run's next steps.
std::vector<std::uint64_t> hashes(RobotState& state, int steps) {
  std::vector<std::uint64_t> list;
  for (int k = 0; k < steps; ++k) {
    state.step();
    list.push_back(state.simulation().state().hash());
  }
  return list;
}

TEST(Timeline, ARunGoesOnBitForBitFromAMoment) {
  const scene::Robot same = robot();
  RobotState state(same, std::make_shared<sim::Simulation>(same.model), same.controllers.at(0));
  for (int k = 0; k < 20; ++k) state.step();
  const Moment steered = state.moment();
  const auto after = hashes(state, 15);
  // Commands, the controller, its target and the mouse spring have changed since.
  state.choose_controller(std::nullopt);
  state.command({"up", "tension", 3.0});
  const Moment by_hand = state.moment();
  const auto pulled = hashes(state, 10);
  state.set_target({"tip", Vector3(0.06, 0.012, 0.01)});
  state.pull({"beam", {0, 1, 2}, Vector3(1, 0, 0), Vector3(0.1, 0, 0.1), 5.0});
  for (int k = 0; k < 5; ++k) state.step();
  state.go_back(steered);
  EXPECT_EQ(hashes(state, 15), after);
  state.go_back(by_hand);
  EXPECT_EQ(hashes(state, 10), pulled);
  state.go_back(steered);
  EXPECT_EQ(hashes(state, 15), after);
}

struct Live {
  Live() : source(robot(), {.controller = "hold", .playing = false}) { source.start(watcher); }
  ~Live() { source.stop(); }
  Outcome ask(const Request& request) {
    std::promise<Outcome> done;
    source.submit(request, [&](const Outcome& outcome) { done.set_value(outcome); });
    return done.get_future().get();
  }
  /// Waits for the frame of a step.
  std::shared_ptr<const Frame> at(std::uint64_t step) {
    for (int k = 0; k < 3000; ++k) {
      if (auto frame = watcher.frame(); frame && frame->step == step) return frame;
      std::this_thread::sleep_for(10ms);
    }
    throw std::runtime_error("no such frame");
  }
  Watcher watcher;
  LiveSource source;
};

TEST(Timeline, APageGoesBackAndTakesAnotherWay) {
  Live live;
  live.ask(Step{50});
  const auto end = live.at(50);
  ASSERT_TRUE(end->timeline.has_value());
  EXPECT_EQ(end->timeline->oldest, 0);
  EXPECT_EQ(end->timeline->shown, end->timeline->latest);
  EXPECT_EQ(kind(live.ask(Seek{5})), "");  // with steps of 10 ms, every fourth is a moment
  const auto back = live.at(20);
  EXPECT_EQ(back->timeline->shown, 5);
  EXPECT_GT(back->timeline->latest, 5);
  EXPECT_FLOAT_EQ(static_cast<float>(back->timeline->latest_time), 0.5F);
  EXPECT_EQ(kind(live.ask(Seek{back->timeline->latest})), "");
  EXPECT_EQ(live.at(50)->hash, end->hash) << "nothing is lost by looking back";
  EXPECT_EQ(kind(live.ask(Seek{5})), "");
  live.ask(Step{30});
  const auto again = live.at(50);
  EXPECT_EQ(again->hash, end->hash) << "the same way once more";
  EXPECT_EQ(again->timeline->shown, again->timeline->latest);
  EXPECT_EQ(kind(live.ask(Seek{5})), "");
  live.ask(ChooseController{std::nullopt});
  live.ask(SetCommand{"up", "tension", 2.0});
  live.ask(Step{30});
  EXPECT_NE(live.at(50)->hash, end->hash) << "another way";
  EXPECT_EQ(kind(live.ask(Reset{})), "");
  EXPECT_EQ(live.at(0)->timeline->latest, 0);
}

TEST(Timeline, ARunThatStoppedGoesBack) {
  Live live;
  live.ask(ChooseController{std::nullopt});
  live.ask(Step{20});
  live.ask(SetCommand{"push", "force", -1e6});
  EXPECT_TRUE(live.ask(Step{50}).has_value());
  EXPECT_EQ(kind(live.ask(Seek{2})), "");
  live.at(8);
  EXPECT_EQ(kind(live.ask(Step{3})), "") << "with the command of that time";
}

TEST(RealTimeFactor, IsRightFromTheStart) {
  RealTimeFactor factor;
  const auto start = RealTimeFactor::Time{} + 1h;
  const auto run = [&](int from, int to, double speed) {
    for (int k = from; k < to; ++k) factor.add(start + k * 10ms, speed * 0.01 * k);
  };
  factor.add(start, 0.0);
  EXPECT_TRUE(std::isnan(factor.value()));
  run(1, 20, 0.5);
  EXPECT_TRUE(std::isnan(factor.value())) << "too short to tell";
  run(20, 22, 0.5);
  EXPECT_NEAR(factor.value(), 0.5, 1e-9);
  run(22, 200, 0.5);
  EXPECT_NEAR(factor.value(), 0.5, 1e-9);
  factor.restart();
  // Steps longer than the window.
  for (int k = 0; k < 4; ++k) factor.add(start + k * 2s, 0.01 * k);
  EXPECT_NEAR(factor.value(), 0.005, 1e-9);
}

}  // namespace
}  // namespace sinew::viewer
