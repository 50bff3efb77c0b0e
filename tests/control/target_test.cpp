#include "sinew/control/target.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

namespace sinew::control {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Points points(std::initializer_list<Vector3> rows) {
  Points result(static_cast<Eigen::Index>(rows.size()), 3);
  Eigen::Index i = 0;
  for (const Vector3& row : rows) result.row(i++) = row.transpose();
  return result;
}

TEST(Target, FixedStaysWhereItIs) {
  const Target target = Target::fixed({1.0, 2.0, 3.0});
  EXPECT_EQ(target.at(0.0), Vector3(1.0, 2.0, 3.0));
  EXPECT_EQ(target.at(5.0), Vector3(1.0, 2.0, 3.0));
  EXPECT_EQ(target.end_time(), 0.0);
  EXPECT_EQ(Target().at(1.0), Vector3::Zero().eval());
}

TEST(Target, CircleAboutZStartsOnXAndTurnsLeft) {
  const Target target = Target::circle(
      {.centre = {0.0, 0.0, 0.19}, .radius = 0.03, .normal = {0.0, 0.0, 2.0}, .period = 10.0});
  EXPECT_LT((target.at(0.0) - Vector3(0.03, 0.0, 0.19)).norm(), 1e-15);
  EXPECT_LT((target.at(2.5) - Vector3(0.0, 0.03, 0.19)).norm(), 1e-15);
  EXPECT_LT((target.at(5.0) - Vector3(-0.03, 0.0, 0.19)).norm(), 1e-15);
  EXPECT_LT((target.at(10.0) - target.at(0.0)).norm(), 1e-15);
  EXPECT_EQ(target.end_time(), 10.0);
}

TEST(Target, CircleStartsAtItsAngle) {
  const Target target =
      Target::circle({.radius = 1.0, .period = 1.0, .start_angle = std::numbers::pi / 2.0});
  EXPECT_LT((target.at(0.0) - Vector3::UnitY()).norm(), 1e-15);
}

TEST(Target, CircleLiesInItsPlaneForEveryNormal) {
  for (int i = 0; i < 200; ++i) {
    const Vector3 normal(std::sin(1.7 * i), std::cos(0.9 * i), std::sin(0.3 * i + 1.0));
    const Vector3 centre(0.1 * i, -0.2, 0.3);
    const Target target =
        Target::circle({.centre = centre, .radius = 0.5, .normal = normal, .period = 3.0});
    const Vector3 axis = normal.normalized();
    for (const double time : {0.0, 0.4, 1.1, 2.9}) {
      const Vector3 arm = target.at(time) - centre;
      ASSERT_NEAR(arm.norm(), 0.5, 1e-14);
      ASSERT_NEAR(arm.dot(axis), 0.0, 1e-14);
      const Vector3 later = target.at(time + 0.1) - centre;
      ASSERT_GT(arm.cross(later).dot(axis), 0.0) << "turns the wrong way";
    }
  }
}

TEST(Target, CircleAboutXStartsOnY) {
  const Target target = Target::circle({.radius = 1.0, .normal = Vector3::UnitX()});
  EXPECT_LT((target.at(0.0) - Vector3::UnitY()).norm(), 1e-15);
}

TEST(Target, OpenPolylineHasConstantSpeedAndHoldsItsEnd) {
  // 1 m then 3 m: after a quarter of the time the corner is reached.
  const Target target = Target::polyline(
      {.points = points({{0, 0, 0}, {1, 0, 0}, {1, 3, 0}}), .period = 8.0, .closed = false});
  EXPECT_LT((target.at(1.0) - Vector3(0.5, 0, 0)).norm(), 1e-15);
  EXPECT_LT((target.at(2.0) - Vector3(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((target.at(5.0) - Vector3(1, 1.5, 0)).norm(), 1e-15);
  EXPECT_EQ(target.at(8.0), Vector3(1, 3, 0));
  EXPECT_EQ(target.at(80.0), Vector3(1, 3, 0));
  EXPECT_EQ(target.at(-1.0), Vector3(0, 0, 0));
  EXPECT_EQ(target.end_time(), 8.0);
}

TEST(Target, ClosedPolylineReturnsAndRepeats) {
  const Points corners = points({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  EXPECT_EQ(Target::length(corners, false), 3.0);
  EXPECT_EQ(Target::length(corners, true), 4.0);
  const Target target = Target::polyline({.points = corners, .period = 4.0, .closed = true});
  EXPECT_LT((target.at(3.5) - Vector3(0, 0.5, 0)).norm(), 1e-15);
  EXPECT_LT((target.at(4.0) - Vector3(0, 0, 0)).norm(), 1e-15);
  EXPECT_LT((target.at(13.5) - Vector3(1, 0.5, 0)).norm(), 1e-14);
  EXPECT_EQ(target.end_time(), 4.0);
}

TEST(Target, RepeatedPointsOfAPolylineDoNotStopIt) {
  const Target target = Target::polyline(
      {.points = points({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}}),
       .period = 2.0});
  for (const double time : {0.0, 0.25, 1.0, 1.5, 2.0, 3.0}) {
    EXPECT_NEAR(target.at(time).x(), std::min(time, 2.0), 1e-15) << time;
    EXPECT_TRUE(target.at(time).allFinite());
  }
}

TEST(Target, TrajectoryIsStraightBetweenSamples) {
  const Target target =
      Target::trajectory({0.5, 1.5, 2.0}, points({{0, 0, 0}, {2, 0, 0}, {2, 4, 0}}));
  EXPECT_EQ(target.at(0.0), Vector3(0, 0, 0));
  EXPECT_LT((target.at(1.0) - Vector3(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((target.at(1.75) - Vector3(2, 2, 0)).norm(), 1e-15);
  EXPECT_EQ(target.at(5.0), Vector3(2, 4, 0));
  EXPECT_EQ(target.end_time(), 2.0);
}

struct BadTarget {
  const char* name;
  std::function<Target()> make;
  ErrorKind kind;
};

class BadTargets : public ::testing::TestWithParam<BadTarget> {};

TEST_P(BadTargets, AreRefused) {
  try {
    GetParam().make();
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error_kind_name(error.kind()), error_kind_name(GetParam().kind));
    EXPECT_FALSE(error.remedy().empty());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Target, BadTargets,
    ::testing::Values(
        BadTarget{"fixed_nan",
                  [] {
                    return Target::fixed({0.0, kNan, 0.0});
                  },
                  ErrorKind::not_finite},
        BadTarget{"circle_radius", [] { return Target::circle({.radius = 0.0}); },
                  ErrorKind::out_of_range},
        BadTarget{"circle_period", [] { return Target::circle({.radius = 1.0, .period = -1.0}); },
                  ErrorKind::out_of_range},
        BadTarget{"circle_normal",
                  [] { return Target::circle({.radius = 1.0, .normal = Vector3::Zero()}); },
                  ErrorKind::out_of_range},
        BadTarget{"circle_centre_nan",
                  [] {
                    return Target::circle({.centre = {kNan, 0.0, 0.0}, .radius = 1.0});
                  },
                  ErrorKind::not_finite},
        BadTarget{"circle_angle_nan",
                  [] { return Target::circle({.radius = 1.0, .start_angle = kNan}); },
                  ErrorKind::not_finite},
        BadTarget{"line_one_point",
                  [] {
                    return Target::polyline({.points = points({{0, 0, 0}}), .period = 1.0});
                  },
                  ErrorKind::too_few_points},
        BadTarget{"line_no_length",
                  [] {
                    return Target::polyline(
                        {.points = points({{1, 1, 1}, {1, 1, 1}}), .period = 1.0, .closed = true});
                  },
                  ErrorKind::out_of_range},
        BadTarget{"line_no_period",
                  [] {
                    return Target::polyline({.points = points({{0, 0, 0}, {1, 0, 0}})});
                  },
                  ErrorKind::out_of_range},
        BadTarget{
            "line_nan",
            [] {
              return Target::polyline({.points = points({{0, 0, 0}, {1, 0, kNan}}), .period = 1.0});
            },
            ErrorKind::not_finite},
        BadTarget{"trajectory_length",
                  [] {
                    return Target::trajectory({0.0}, points({{0, 0, 0}, {1, 0, 0}}));
                  },
                  ErrorKind::wrong_length},
        BadTarget{"trajectory_time",
                  [] {
                    return Target::trajectory({1.0, 1.0}, points({{0, 0, 0}, {1, 0, 0}}));
                  },
                  ErrorKind::non_monotonic_time},
        BadTarget{"trajectory_early",
                  [] {
                    return Target::trajectory({-1.0, 1.0}, points({{0, 0, 0}, {1, 0, 0}}));
                  },
                  ErrorKind::non_monotonic_time},
        BadTarget{"trajectory_nan",
                  [] {
                    return Target::trajectory({0.0, kNan}, points({{0, 0, 0}, {1, 0, 0}}));
                  },
                  ErrorKind::not_finite},
        BadTarget{"trajectory_one",
                  [] {
                    return Target::trajectory({0.0}, points({{0, 0, 0}}));
                  },
                  ErrorKind::too_few_points}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sinew::control
