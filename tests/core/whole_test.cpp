#include "sinew/core/whole.hpp"

#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

namespace sinew {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Whole, TruncatesWithinTheBounds) {
  EXPECT_EQ(whole<int>(2.9), 2);
  EXPECT_EQ(whole<int>(-2.9), -2);
  EXPECT_EQ(whole<int>(5e-324), 0);
  EXPECT_EQ(whole<int>(9.0, 0, 9), 9);
  EXPECT_EQ(whole<std::int64_t>(4503599627370497.0), 4503599627370497);
}

template <typename To>
void stops_at_the_bounds() {
  constexpr To kLeast = std::numeric_limits<To>::min(), kMost = std::numeric_limits<To>::max();
  for (const double large : {kInfinity, 1e308, 1e155, static_cast<double>(kMost) * 1.5}) {
    EXPECT_EQ(whole<To>(large), kMost) << large;
    EXPECT_EQ(whole<To>(-large), kLeast) << -large;
  }
  // 2^63 and 2^64 are doubles, the largest 64-bit integers are not.
  EXPECT_EQ(whole<To>(static_cast<double>(kMost)), kMost);
  EXPECT_EQ(whole<To>(static_cast<double>(kLeast)), kLeast);
  EXPECT_EQ(whole<To>(kNan), kLeast);
  EXPECT_EQ(whole<To>(kNan, 1, 7), To{1});
  EXPECT_EQ(whole<To>(1e300, 1, 7), To{7});
  EXPECT_EQ(whole<To>(-1e300, 1, 7), To{1});
}

TEST(Whole, StopsAtTheBoundsOfEveryType) {
  stops_at_the_bounds<int>();
  stops_at_the_bounds<std::int64_t>();
  stops_at_the_bounds<std::size_t>();
  stops_at_the_bounds<std::uint8_t>();
}

TEST(WholeCount, RefusesWhatIsNoCount) {
  EXPECT_EQ(whole_count<int>(3.2, 10.0, "steps", "take fewer"), 3);
  for (const double wrong : {kNan, kInfinity, -kInfinity, 0.0, -1.0, 11.0, 1e308}) {
    try {
      whole_count<int>(wrong, 10.0, "steps", "take fewer");
      ADD_FAILURE() << wrong;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::out_of_range);
      EXPECT_EQ(error.remedy(), "take fewer");
    }
  }
}

}  // namespace
}  // namespace sinew
