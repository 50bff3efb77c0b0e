#include "sinew/run/kept_factors.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace sinew::sim {
namespace {

TEST(KeptFactors, ServeWhileNothingElseIsKnown) {
  EXPECT_TRUE(run::KeptFactors{}.pays(1e-1, 1e-8));
  EXPECT_TRUE(run::KeptFactors{}.will_pay(1e-8));
}

// From 1e-3 to 1e-6, motions that leave a tenth each are three, those that leave a quarter five.
TEST(KeptFactors, PayIfFewMotionsReachTheTolerance) {
  run::KeptFactors good, poor;
  good.take(0.1, 1e-3);
  poor.take(0.25, 1e-3);
  EXPECT_TRUE(good.will_pay(1e-6));
  EXPECT_FALSE(good.will_pay(1e-8));
  EXPECT_FALSE(poor.will_pay(1e-6));
  EXPECT_TRUE(poor.pays(5e-5, 1e-6));
  EXPECT_TRUE(poor.pays(5e-7, 1e-6));
}

TEST(KeptFactors, AreTriedAgainAfterSomeSearchesWithoutOne) {
  run::KeptFactors refused;
  refused.take(1.0, 1e-2);
  for (int k = 0; k < 15; ++k) {
    EXPECT_FALSE(refused.pays(1.1e-6, 1e-6)) << k;
    refused.take(0.0, 1e-2);
  }
  EXPECT_FALSE(refused.will_pay(1e-6));
  refused.take(0.0, 1e-2);
  EXPECT_TRUE(refused.will_pay(1e-6));
}

TEST(KeptFactors, AreRememberedInAState) {
  run::KeptFactors known;
  std::vector<double> numbers;
  known.save(numbers);
  EXPECT_TRUE(numbers.empty());
  known.take(0.25, 1e-3);
  known.take(0.0, 2e-3);
  known.save(numbers);
  run::KeptFactors again(numbers);
  std::vector<double> same;
  again.save(same);
  EXPECT_EQ(same, numbers);
  EXPECT_FALSE(again.will_pay(1e-6));
}

}  // namespace
}  // namespace sinew::sim
