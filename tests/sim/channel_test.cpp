#include "sinew/sense/channel.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

namespace sinew::sim {
namespace {

constexpr double kStep = 0.01;  // s
constexpr int kSamples = 20000;

void offer(sense::Channel& channel, double time, double value) {
  const std::array truth{value};
  channel.offer(time, truth);
}

// Samples of a constant, one per step.
std::vector<double> samples(const sense::ChannelSettings& settings, double truth,
                            int count = kSamples) {
  sense::Channel channel(settings, 1);
  std::vector<double> values;
  for (int k = 0; k < count; ++k) {
    offer(channel, k * kStep, truth);
    if (channel.fresh()) values.push_back(channel.value()[0]);
  }
  return values;
}

struct Moments {
  double mean = 0.0, variance = 0.0, lag = 0.0;  // lag: correlation of successive samples
};

Moments moments_of(const std::vector<double>& x) {
  Moments m;
  const auto n = static_cast<double>(x.size());
  for (const double v : x) m.mean += v / n;
  for (const double v : x) m.variance += (v - m.mean) * (v - m.mean) / (n - 1.0);
  for (std::size_t k = 1; k < x.size(); ++k) {
    m.lag += (x[k] - m.mean) * (x[k - 1] - m.mean) / (n * m.variance);
  }
  return m;
}

// For n independent normal samples, the standard deviation of the mean is s/sqrt(n), that of the
// variance s^2 sqrt(2/n), and that of the correlation of successive samples 1/sqrt(n). The
// tolerance is five of each: one correct generator in two million fails a check.
TEST(Channel, NoiseIsWhiteAndNormal) {
  const double truth = 3.0, noise = 0.2;
  const auto values = samples({.noise = noise, .bias = 0.05, .seed = 3}, truth);
  ASSERT_EQ(values.size(), std::size_t{kSamples});
  const Moments m = moments_of(values);
  EXPECT_NEAR(m.mean, truth + 0.05, 5.0 * noise / std::sqrt(kSamples));
  EXPECT_NEAR(m.variance, noise * noise, 5.0 * noise * noise * std::sqrt(2.0 / kSamples));
  EXPECT_NEAR(m.lag, 0.0, 5.0 / std::sqrt(kSamples));
  // The fraction within one standard deviation, which has a binomial distribution.
  const double p = std::erf(std::sqrt(0.5));
  double within = 0.0;
  for (const double v : values) within += std::abs(v - truth - 0.05) <= noise ? 1.0 : 0.0;
  EXPECT_NEAR(within / kSamples, p, 5.0 * std::sqrt(p * (1.0 - p) / kSamples));
}

TEST(Channel, ComponentsAndStreamsAreIndependent) {
  sense::Channel a({.noise = 1.0, .seed = 1, .stream = 1}, 2),
      b({.noise = 1.0, .seed = 1, .stream = 2}, 2);
  const std::array truth{0.0, 0.0};
  double between = 0.0, across = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    a.offer(k * kStep, truth);
    b.offer(k * kStep, truth);
    between += a.value()[0] * a.value()[1] / kSamples;
    across += a.value()[0] * b.value()[0] / kSamples;
  }
  EXPECT_NEAR(between, 0.0, 5.0 / std::sqrt(kSamples));
  EXPECT_NEAR(across, 0.0, 5.0 / std::sqrt(kSamples));
}

// After a time t, the random walk has the variance drift^2 t, whatever the sampling rate.
TEST(Channel, DriftGrowsWithTheRootOfTime) {
  constexpr int kWalks = 4000;
  for (const double step : {0.01, 0.1}) {
    double variance = 0.0;
    for (int w = 0; w < kWalks; ++w) {
      sense::Channel channel({.drift = 0.3, .seed = static_cast<std::uint64_t>(w)}, 1);
      const int count = static_cast<int>(std::lround(2.0 / step));
      for (int k = 0; k <= count; ++k) offer(channel, k * step, 0.0);
      variance += channel.value()[0] * channel.value()[0] / kWalks;
    }
    const double expected = 0.3 * 0.3 * 2.0;
    EXPECT_NEAR(variance, expected, 5.0 * expected * std::sqrt(2.0 / kWalks)) << step;
  }
}

TEST(Channel, RoundsToTheQuantumAndSaturates) {
  const double quantum = 0.25;
  const sense::ChannelSettings settings{.quantum = quantum, .min = -1.0, .max = 2.1};
  for (int k = -400; k <= 400; ++k) {
    sense::Channel channel(settings, 1);
    const double x = 0.01 * k + 0.003;
    offer(channel, 0.0, x);
    const double y = channel.value()[0];
    EXPECT_TRUE(y >= -1.0 && y <= 2.1) << x;
    if (y > -1.0 && y < 2.1) {
      EXPECT_EQ(std::remainder(y, quantum), 0.0) << x;
      EXPECT_LE(std::abs(y - x), 0.5 * quantum * (1.0 + 1e-12)) << x;
    }
  }
  // The rounding error of a uniformly varying value is quantum/sqrt(12).
  double squares = 0.0;
  sense::Channel fine({.quantum = quantum}, 1);
  for (int k = 0; k < kSamples; ++k) {
    const double x = 1e-4 * k;  // over eight quanta
    offer(fine, k * kStep, x);
    squares += (fine.value()[0] - x) * (fine.value()[0] - x) / kSamples;
  }
  EXPECT_NEAR(std::sqrt(squares), fine.settings().standard_deviation(), 1e-3 * quantum);
}

TEST(Channel, SamplesAtItsRateAndDeliversWithItsDelayToTheStep) {
  sense::Channel channel({.rate = 20.0, .delay = 0.03}, 1);
  for (int k = 0; k < 1000; ++k) {
    offer(channel, k * kStep, k);
    // Samples are taken at every fifth step and arrive three steps later.
    const int last = (k - 3) / 5 * 5;
    EXPECT_EQ(channel.fresh(), k >= 3 && (k - 3) % 5 == 0) << k;
    if (k < 3) {
      EXPECT_FALSE(channel.has_value());
      EXPECT_TRUE(std::isnan(channel.value()[0]));
    } else {
      EXPECT_EQ(channel.value()[0], last) << k;
      EXPECT_EQ(channel.time(), last * kStep) << k;
    }
  }
  EXPECT_EQ(channel.samples(), 200);
}

TEST(Channel, ADelayBetweenStepsEndsAtTheNext) {
  sense::Channel channel({.delay = 0.014}, 1);
  for (int k = 0; k < 10; ++k) {
    offer(channel, k * kStep, k);
    if (k >= 2) {
      EXPECT_EQ(channel.value()[0], k - 2);
    }
  }
}

TEST(Channel, LosesItsShareOfSamples) {
  const double p = 0.15;
  const auto values = samples({.dropout = p, .seed = 8}, 1.0);
  const double lost = 1.0 - static_cast<double>(values.size()) / kSamples;
  EXPECT_NEAR(lost, p, 5.0 * std::sqrt(p * (1.0 - p) / kSamples));
  EXPECT_TRUE(samples({.dropout = 1.0}, 1.0, 100).empty());
  sense::Channel channel({.dropout = p, .seed = 8}, 1);
  for (int k = 0; k < kSamples; ++k) offer(channel, k * kStep, 1.0);
  EXPECT_EQ(channel.samples(), kSamples);
  EXPECT_EQ(channel.missing(), kSamples - static_cast<std::int64_t>(values.size()));
}

const sense::ChannelSettings kAll{.noise = 0.1,
                                  .bias = 0.2,
                                  .drift = 0.3,
                                  .quantum = 1e-3,
                                  .rate = 50.0,
                                  .delay = 0.07,
                                  .dropout = 0.2,
                                  .timeout = 0.2,
                                  .seed = 5};

TEST(Channel, GoesOnFromItsMemoryBitForBit) {
  sense::Channel whole(kAll, 3), first(kAll, 3);
  const auto truth = [](int k) { return std::array{0.1 * k, std::sin(k), -1.0 * k}; };
  std::vector<double> memory;
  for (int k = 0; k < 57; ++k) {
    whole.offer(k * kStep, truth(k));
    first.offer(k * kStep, truth(k));
  }
  first.save(memory);
  for (const double number : memory) EXPECT_TRUE(std::isfinite(number));
  sense::Channel second(kAll, 3), copy = first;
  std::span<const double> rest(memory);
  ASSERT_TRUE(second.load(rest));
  EXPECT_TRUE(rest.empty());
  for (int k = 57; k < 300; ++k) {
    whole.offer(k * kStep, truth(k));
    second.offer(k * kStep, truth(k));
    copy.offer(k * kStep, truth(k));
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(second.value()[c], whole.value()[c]);
      EXPECT_EQ(copy.value()[c], whole.value()[c]);
    }
    EXPECT_EQ(second.time(), whole.time());
    EXPECT_EQ(second.fresh(), whole.fresh());
  }
  EXPECT_EQ(second.missing(), whole.missing());
  second.restart();
  sense::Channel anew(kAll, 3);
  for (int k = 0; k < 100; ++k) {
    second.offer(k * kStep, truth(k));
    anew.offer(k * kStep, truth(k));
  }
  EXPECT_EQ(second.value()[1], anew.value()[1]);
}

TEST(Channel, RefusesTheMemoryOfAnother) {
  sense::Channel three(kAll, 3), two(kAll, 2);
  std::vector<double> memory;
  three.save(memory);
  std::span<const double> rest(memory);
  EXPECT_FALSE(two.load(rest));
  memory.resize(memory.size() - 1);
  rest = memory;
  EXPECT_FALSE(three.load(rest));
}

TEST(Channel, SettlesWithAFreshSampleOfItsOwn) {
  sense::Channel channel({.noise = 0.1, .delay = 0.05, .dropout = 0.5, .seed = 2}, 1);
  offer(channel, 0.0, 7.0);
  std::vector<double> values;
  for (int k = 0; k < 2000; ++k) {
    const std::array truth{1.0};
    channel.settle(0.0, truth);
    ASSERT_TRUE(channel.fresh() && channel.valid(0.0));
    EXPECT_EQ(channel.time(), 0.0);
    values.push_back(channel.value()[0]);
  }
  const Moments m = moments_of(values);  // delayed samples are dropped; each has its noise
  EXPECT_NEAR(m.mean, 1.0, 5.0 * 0.1 / std::sqrt(2000.0));
  EXPECT_NEAR(m.variance, 0.01, 5.0 * 0.01 * std::sqrt(2.0 / 2000.0));
  for (int k = 1; k <= 4; ++k) offer(channel, k * kStep, 9.0);
  EXPECT_NEAR(channel.value()[0], 1.0, 1.0);
}

TEST(Channel, TakesRealSamplesInPlaceOfSimulatedOnes) {
  sense::Channel channel({.noise = 1.0, .delay = 0.02, .timeout = 0.03}, 2);
  const std::array truth{5.0, 5.0};
  channel.offer(0.0, truth);
  channel.receive(0.004, std::array{1.0, 2.0});
  EXPECT_TRUE(channel.fresh());
  channel.offer(0.01, truth);
  EXPECT_TRUE(channel.fresh());  // since the previous step
  channel.offer(0.02, truth);
  EXPECT_FALSE(channel.fresh());
  EXPECT_EQ(channel.value()[1], 2.0);
  EXPECT_EQ(channel.time(), 0.004);
  channel.receive(0.03, std::array{1.0, std::nan("")});
  EXPECT_EQ(channel.missing(), 1);
  EXPECT_EQ(channel.time(), 0.004);
  EXPECT_TRUE(channel.valid(0.034));
  EXPECT_FALSE(channel.valid(0.036));
  const auto kind_of = [](const std::function<void()>& act) {
    try {
      act();
    } catch (const Error& error) {
      return std::string(error_kind_name(error.kind()));
    }
    return std::string("none");
  };
  EXPECT_EQ(kind_of([&] { channel.receive(0.003, std::array{1.0, 2.0}); }), "non-monotonic-time");
  EXPECT_EQ(kind_of([&] { channel.receive(0.05, std::array{1.0}); }), "wrong-length");
  EXPECT_EQ(kind_of([&] {
              channel.receive(0.05, std::array{1.0, std::numeric_limits<double>::infinity()});
            }),
            "not-finite");
}

TEST(Channel, RefusesWhatMeansNothing) {
  for (const sense::ChannelSettings& settings :
       {sense::ChannelSettings{.noise = -1.0}, sense::ChannelSettings{.drift = -1.0},
        sense::ChannelSettings{.quantum = -1.0}, sense::ChannelSettings{.rate = -1.0},
        sense::ChannelSettings{.delay = -1.0}, sense::ChannelSettings{.dropout = 1.1},
        sense::ChannelSettings{.min = 1.0, .max = 1.0}, sense::ChannelSettings{.timeout = 0.0},
        sense::ChannelSettings{.bias = std::nan("")}}) {
    EXPECT_THROW(sense::Channel(settings, 1), Error);
  }
}

}  // namespace
}  // namespace sinew::sim
