// The loop on a simulated clock, and between threads.
#include "sinew/high_rate/high_rate_loop.hpp"

#include <array>
#include <atomic>
#include <map>
#include <thread>

#include <gtest/gtest.h>

#include "../support/error_kind.hpp"
#include "snapshots.hpp"
#include "walls.hpp"

namespace sinew::high_rate {
namespace {

using sinew::testing::kind_of;
using sinew::testing::robot_settings;
using sinew::testing::wall;
using sinew::testing::wall_settings;

/// A clock that jumps to the end of each sleep. Each period takes 10 us; some are set to take
/// longer or to start late.
class TurnedClock : public Clock {
 public:
  double now() override {
    ++calls_;
    if (calls_ > 1 && calls_ % 2 == 1) {  // the end of a period
      time_ += works_.contains(period_) ? works_.at(period_) : 10e-6;
      ++period_;
    }
    return time_;
  }
  void sleep_until(double time) override {
    time_ = std::max(time_, time + (lates_.contains(period_) ? lates_.at(period_) : 0.0));
  }
  std::map<int, double> works_, lates_;  // s, by period

 private:
  double time_ = 100.0;
  int calls_ = 0, period_ = 0;
};

TEST(HighRateLoop, CountsWhatCameLate) {
  HighRateLoop loop(wall_settings());
  loop.publish(wall());
  TurnedClock clock;
  clock.works_[5] = 2.5e-3;      // misses two periods
  clock.works_[20] = 0.9985e-3;  // in time
  clock.lates_[30] = 0.2e-3;
  clock.lates_[40] = 1.2e-3;
  loop.run(clock, 100);
  const HighRateReport report = loop.report();
  EXPECT_EQ(report.periods, 100);
  EXPECT_EQ(report.missed, 2 + 1);
  EXPECT_EQ(report.snapshots, 1);
  EXPECT_EQ(loop.lateness().count(), 100);
  EXPECT_EQ(loop.lateness().counts().at(TimeHistogram::kBins), 1);
  EXPECT_NEAR(loop.lateness().longest(), 1.2e-3, 1e-9);
  EXPECT_NEAR(loop.work().quantile(0.5), 10e-6, 1.01e-6);
  EXPECT_NEAR(loop.work().quantile(0.99), 0.999e-3, 1e-9);
  EXPECT_NEAR(loop.work().quantile(1.0), 2.5e-3, 1e-9);
}

TEST(HighRateLoop, RunsOnTheLatestSnapshotAndInput) {
  HighRateLoop loop(wall_settings());
  HighRateInput input = HighRateInput::none(loop.settings());
  TurnedClock clock;
  loop.run(clock, 3);
  EXPECT_EQ(loop.output().state, HighRateState::waiting);
  loop.publish(wall(500.0));
  loop.publish(wall(2000.0));
  input.hands[0] = 1e-3;
  loop.set_input(input);
  loop.run(clock, 20);
  EXPECT_NEAR(loop.output().hands[0], 2.0, 1e-6);
  EXPECT_EQ(loop.output().state, HighRateState::running);
  EXPECT_EQ(loop.report().snapshots, 1);
  loop.run(clock, 130);  // nobody publishes
  EXPECT_EQ(loop.output().state, HighRateState::holding);
  EXPECT_NEAR(loop.output().snapshot_age, 0.149, 2e-3) << "ages go on from run to run";
}

TEST(HighRateLoop, RefusesWhatDoesNotFit) {
  HighRateLoop loop(robot_settings(1, 2));
  EXPECT_EQ(kind_of([&] { loop.publish(wall()); }), ErrorKind::wrong_shape);
  HighRateInput input = HighRateInput::none(loop.settings());
  input.targets.resize(2);
  EXPECT_EQ(kind_of([&] { loop.set_input(input); }), ErrorKind::wrong_shape);
  input = HighRateInput::none(loop.settings());
  input.hands[0] = kInfinity;
  EXPECT_EQ(kind_of([&] { loop.set_input(input); }), ErrorKind::not_finite);
}

TEST(HighRateLoop, StartsStopsAndStartsAgain) {
  HighRateLoop loop(wall_settings());
  loop.publish(wall());
  EXPECT_EQ(loop.report().scheduling, "not started");
  for (int round = 0; round < 2; ++round) {
    const std::int64_t before = loop.report().periods;
    loop.start();
    EXPECT_EQ(kind_of([&] { loop.start(); }), ErrorKind::bad_argument);
    TurnedClock clock;
    EXPECT_EQ(kind_of([&] { loop.run(clock, 1); }), ErrorKind::bad_argument);
    while (loop.report().periods < before + 3) std::this_thread::yield();
    loop.stop();
    EXPECT_FALSE(loop.running());
  }
  const HighRateReport report = loop.report();
  EXPECT_EQ(report.real_time, report.scheduling == "SCHED_FIFO");
  EXPECT_FALSE(report.scheduling.empty());
}

// A writer and a reader at full speed: values are whole, and each is later than the one before.
TEST(TripleBuffer, HandsOverWholeValues) {
  using Value = std::array<long, 64>;
  TripleBuffer<Value> buffer;
  std::atomic<long> taken{0}, last{0};
  std::thread writer([&] {
    long k = 0;
    while (k < 20000 || taken < 100) {
      buffer.slot().fill(++k);
      buffer.publish();
      if (k % 16 == 0) std::this_thread::yield();
    }
    last = k;
  });
  long before = 0;
  bool whole = true, in_order = true;
  while (last == 0 || before < last) {
    if (!buffer.take()) {
      std::this_thread::yield();
      continue;
    }
    const Value& value = buffer.value();
    for (const long entry : value) whole = whole && entry == value[0];
    in_order = in_order && value[0] > before;
    before = value[0];
    ++taken;
  }
  writer.join();
  EXPECT_TRUE(whole);
  EXPECT_TRUE(in_order);
  EXPECT_FALSE(buffer.take());
}

// Snapshots and inputs are set and outputs are read while the loop runs.
TEST(HighRateLoop, IsUsedByManyThreads) {
  HighRateLoop loop(wall_settings());
  TurnedClock clock;
  std::atomic<bool> ends{false};
  std::thread model([&] {
    for (int k = 0; !ends; ++k) {
      loop.publish(wall(1000.0 + k % 100));
      std::this_thread::yield();
    }
  });
  std::thread user([&] {
    HighRateInput input = HighRateInput::none(loop.settings());
    for (int k = 0; !ends; ++k) {
      input.hands[0] = 1e-5 * (k % 100);
      loop.set_input(input);
      const HighRateOutput output = loop.output();
      EXPECT_GE(output.hands[0], 0.0);
      EXPECT_LE(output.hands[0], 1099.0 * 1e-3 * 2.0);
      EXPECT_GE(loop.report().missed, 0);
      EXPECT_GE(loop.work().quantile(0.5), 0.0);
    }
  });
  std::int64_t periods = 0;
  while (loop.report().snapshots < 50) {
    loop.run(clock, 100);
    periods += 100;
  }
  ends = true;
  model.join();
  user.join();
  EXPECT_EQ(loop.report().periods, periods);
}

}  // namespace
}  // namespace sinew::high_rate
