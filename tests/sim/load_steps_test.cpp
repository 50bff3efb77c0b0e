// Incremental loading when steps above a certain length fail.
#include "sinew/run/load_steps.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace sinew::sim {
namespace {

struct Way {
  double left = 1.0;  // remaining load fraction
  int successes = 0, failures = 0;
};

// @param longest step that succeeds.
Way go(const run::LoadSteps& steps, double longest) {
  Way way;
  double at = 1.0, next = 1.0;
  const auto solve = [&](double share) {
    next = share;
    const bool found = at - share <= longest;
    way.failures += found ? 0 : 1;
    return found;
  };
  const auto keep = [&] {
    at = next;
    ++way.successes;
  };
  way.left = run::take_load_steps(steps, solve, keep, [] {});
  EXPECT_EQ(way.left, at);
  return way;
}

TEST(LoadSteps, OneStepWhereAllSucceed) {
  const Way way = go({.first = 1.0}, 1.0);
  EXPECT_EQ(way.left, 0.0);
  EXPECT_EQ(way.successes, 1);
}

// If the step doubled after every success, it would fail as often as it succeeds.
TEST(LoadSteps, FailuresGrowRarer) {
  for (const double longest : {1.0 / 16, 1.0 / 64, 1.0 / 256}) {
    const Way way = go({.first = 0.5}, longest);
    EXPECT_EQ(way.left, 0.0) << longest;
    EXPECT_LE(way.successes, 1.0 / longest);
    EXPECT_LE(way.failures, 2.0 * std::log2(1.0 / longest)) << longest;
  }
}

TEST(LoadSteps, TheFirstMayHaveToBeLongerThanTheOthers) {
  const run::LoadSteps steps{.first = 0.5, .min = 1.0 / 64, .min_at_first = 1.0 / 16};
  EXPECT_EQ(go(steps, 1.0 / 16).left, 0.0);
  const Way stuck = go(steps, 1.0 / 32);
  EXPECT_EQ(stuck.left, 1.0);
  EXPECT_EQ(stuck.failures, 4);
  EXPECT_EQ(go({.first = 0.5, .min = 1.0 / 64}, 1.0 / 32).left, 0.0);
}

}  // namespace
}  // namespace sinew::sim
