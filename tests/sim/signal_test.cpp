#include "sinew/model/signal.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"

namespace sinew::sim {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Signal, IsZeroUntilToldOtherwise) {
  const model::Signal signal;
  EXPECT_EQ(signal.value(3.0), 0.0);
  EXPECT_EQ(signal.end_time(), 0.0);
  EXPECT_TRUE(signal.is_constant());
}

TEST(Signal, ConstantHoldsForEver) {
  const model::Signal signal = model::Signal::constant(0.01);
  EXPECT_EQ(signal.value(-1.0), 0.01);
  EXPECT_EQ(signal.value(1e9), 0.01);
  EXPECT_EQ(signal.end_time(), 0.0);
}

// Compares with one-sided differences; at corners the two sides differ.
TEST(Signal, RatesOnBothSidesOfCorners) {
  constexpr auto on_before = model::Signal::Side::before, on_after = model::Signal::Side::after;
  const model::Signal signals[] = {
      model::Signal::ramp({.from = 1.0, .to = 3.0, .start = 0.5, .duration = 2.0}),
      model::Signal::sine({.mean = 1.0, .amplitude = 0.3, .period = 0.7, .phase = 0.4}),
      model::Signal::sampled({0.2, 0.5, 2.5}, {1.0, 4.0, -1.0}), model::Signal::constant(2.0),
      model::Signal::steps({{0.0, 1.0}, {0.5, 1.0}})};
  for (const model::Signal& signal : signals) {
    for (const double time : {0.0, 0.1, 0.2, 0.5, 1.7, 2.5, 3.0}) {
      const double far = 1e-6;
      const double after = (signal.value(time + far) - signal.value(time)) / far;
      const double before = (signal.value(time) - signal.value(time - far)) / far;
      EXPECT_NEAR(signal.rate(time, on_after), after, 1e-4) << "at " << time;
      EXPECT_NEAR(signal.rate(time, on_before), before, 1e-4) << "at " << time;
    }
    EXPECT_FALSE(signal.jumps());
  }
  EXPECT_EQ(signals[0].next_corner(0.0), 0.5);
  EXPECT_EQ(signals[0].next_corner(0.5 - 1e-12), 2.5);
  EXPECT_EQ(signals[2].next_corner(2.5), kInfinity);
  EXPECT_TRUE(model::Signal::steps({{0.0, 1.0}, {0.5, 2.0}}).jumps());
}

TEST(Signal, RampIsStraightAndHeldAtBothEnds) {
  const model::Signal signal =
      model::Signal::ramp({.from = 1.0, .to = 3.0, .start = 0.5, .duration = 2.0});
  EXPECT_EQ(signal.value(0.0), 1.0);
  EXPECT_EQ(signal.value(0.5), 1.0);
  EXPECT_DOUBLE_EQ(signal.value(1.0), 1.5);
  EXPECT_EQ(signal.value(2.5), 3.0);
  EXPECT_EQ(signal.value(100.0), 3.0);
  EXPECT_DOUBLE_EQ(signal.end_time(), 2.5);
  EXPECT_FALSE(signal.is_constant());
}

TEST(Signal, SineHasMeanAmplitudePeriodAndPhase) {
  const model::Signal signal = model::Signal::sine(
      {.mean = 2.0, .amplitude = 0.5, .period = 4.0, .phase = std::numbers::pi / 2.0});
  EXPECT_DOUBLE_EQ(signal.value(0.0), 2.5);
  EXPECT_NEAR(signal.value(1.0), 2.0, 1e-15);
  EXPECT_DOUBLE_EQ(signal.value(2.0), 1.5);
  EXPECT_NEAR(signal.value(4.0), 2.5, 1e-15);
  EXPECT_EQ(signal.end_time(), 4.0);
}

TEST(Signal, StepsHoldUntilTheNext) {
  const model::Signal signal = model::Signal::steps({{0.0, 1.0}, {1.0, 5.0}, {2.0, -1.0}});
  EXPECT_EQ(signal.value(0.0), 1.0);
  EXPECT_EQ(signal.value(0.999), 1.0);
  EXPECT_EQ(signal.value(1.0), 5.0);
  EXPECT_EQ(signal.value(7.0), -1.0);
  EXPECT_EQ(signal.end_time(), 2.0);
}

TEST(Signal, RoundingOfStepTimesDelaysNoStep) {
  // n h may be an ulp below the decimal that a user writes, but every jump must come at its step.
  const double h = 0.01;
  for (int n = 1; n < 2000; ++n) {
    const double written = n / 100.0;
    const model::Signal signal = model::Signal::steps({{0.0, 0.0}, {written, 1.0}});
    ASSERT_EQ(signal.value(n * h), 1.0) << "step " << n;
    ASSERT_EQ(signal.value((n - 1) * h), 0.0) << "step " << n;
  }
}

TEST(Signal, SamplesAreJoinedByStraightLines) {
  const model::Signal signal = model::Signal::sampled({1.0, 2.0, 4.0}, {10.0, 20.0, 0.0});
  EXPECT_EQ(signal.value(0.0), 10.0);
  EXPECT_EQ(signal.value(1.0), 10.0);
  EXPECT_DOUBLE_EQ(signal.value(1.5), 15.0);
  EXPECT_EQ(signal.value(2.0), 20.0);
  EXPECT_DOUBLE_EQ(signal.value(3.0), 10.0);
  EXPECT_EQ(signal.value(4.0), 0.0);
  EXPECT_EQ(signal.value(9.0), 0.0);
  EXPECT_EQ(signal.end_time(), 4.0);
}

TEST(Signal, OneSampleIsEnough) {
  EXPECT_EQ(model::Signal::sampled({2.0}, {7.0}).value(0.0), 7.0);
  EXPECT_EQ(model::Signal::sampled({2.0}, {7.0}).value(3.0), 7.0);
}

struct BadSignal {
  const char* name;
  std::function<model::Signal()> make;
  ErrorKind kind;
  const char* message;
};

class BadSignals : public ::testing::TestWithParam<BadSignal> {};

TEST_P(BadSignals, AreRefused) {
  try {
    GetParam().make();
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error_kind_name(error.kind()), error_kind_name(GetParam().kind));
    EXPECT_NE(error.message().find(GetParam().message), std::string::npos) << error.what();
    EXPECT_FALSE(error.remedy().empty());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Signal, BadSignals,
    ::testing::Values(BadSignal{"constant_nan", [] { return model::Signal::constant(kNan); },
                                ErrorKind::not_finite, "nan"},
                      BadSignal{"ramp_infinite",
                                [] {
                                  return model::Signal::ramp({0.0, kInfinity, 0.0, 1.0});
                                },
                                ErrorKind::not_finite, "inf"},
                      BadSignal{"ramp_backwards",
                                [] {
                                  return model::Signal::ramp({0.0, 1.0, 0.0, -1.0});
                                },
                                ErrorKind::bad_signal, "-1"},
                      BadSignal{"ramp_instant",
                                [] {
                                  return model::Signal::ramp({0.0, 1.0, 0.0, 0.0});
                                },
                                ErrorKind::bad_signal, "lasts 0"},
                      BadSignal{"ramp_early",
                                [] {
                                  return model::Signal::ramp({0.0, 1.0, -0.5, 1.0});
                                },
                                ErrorKind::bad_signal, "-0.5"},
                      BadSignal{"sine_period",
                                [] {
                                  return model::Signal::sine({0.0, 1.0, 0.0, 0.0});
                                },
                                ErrorKind::bad_signal, "period is 0"},
                      BadSignal{"sine_nan",
                                [] {
                                  return model::Signal::sine({0.0, kNan, 1.0, 0.0});
                                },
                                ErrorKind::not_finite, "nan"},
                      BadSignal{"steps_none", [] { return model::Signal::steps({}); },
                                ErrorKind::bad_signal, "no values"},
                      BadSignal{"steps_late",
                                [] {
                                  return model::Signal::steps({{1.0, 2.0}});
                                },
                                ErrorKind::bad_signal, "begin at 1 s"},
                      BadSignal{"steps_equal",
                                [] {
                                  return model::Signal::steps({{0.0, 1.0}, {0.0, 2.0}});
                                },
                                ErrorKind::non_monotonic_time, "0 s"},
                      BadSignal{"steps_nan",
                                [] {
                                  return model::Signal::steps({{0.0, 1.0}, {1.0, kNan}});
                                },
                                ErrorKind::not_finite, "nan"},
                      BadSignal{"samples_back",
                                [] {
                                  return model::Signal::sampled({0.0, 2.0, 1.0}, {0, 0, 0});
                                },
                                ErrorKind::non_monotonic_time, "1 s"},
                      BadSignal{"samples_early",
                                [] {
                                  return model::Signal::sampled({-1.0, 0.0}, {0, 0});
                                },
                                ErrorKind::bad_signal, "-1 s"},
                      BadSignal{"samples_nan_time",
                                [] {
                                  return model::Signal::sampled({kNan, 0.0}, {0, 0});
                                },
                                ErrorKind::not_finite, "nan"},
                      BadSignal{"samples_length",
                                [] {
                                  return model::Signal::sampled({0.0, 1.0}, {0.0});
                                },
                                ErrorKind::wrong_length, "2 times but 1"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sinew::sim
