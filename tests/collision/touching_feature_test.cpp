#include "sinew/collision/touching_feature.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/collision/touching_points.hpp"

namespace sinew::collision {
namespace {

struct RoundPair {
  const char* name;
  Shape first, second;
};

// Pairs in contact or slightly apart, one of them round.
std::vector<RoundPair> round_pairs() {
  const Matrix3 tilted = Eigen::AngleAxisd(0.3, Vector3(1.0, 2.0, 0.5).normalized()).matrix();
  const Sphere ball{{0.1, -0.2, 1.01}, 1.0};
  const Plane floor{};
  const OrientedBox table{{0.0, 0.0, -0.5}, Matrix3::Identity(), {2.0, 2.0, 0.5}};
  const Capsule lying{{-0.7, 0.1, -0.5}, {0.9, -0.2, -0.4}, 0.45};
  return {{"ball on plane", ball, floor},
          {"ball on box", ball, table},
          {"ball on ball", ball, Sphere{{-0.3, 0.2, -0.9}, 1.0}},
          {"ball on capsule", ball, lying},
          {"capsule across capsule", Capsule{{0.1, -1.0, 0.5}, {0.2, 1.0, 0.6}, 0.5}, lying},
          {"edge on capsule", OrientedBox{{0.0, 0.0, 1.1}, tilted, {0.9, 0.8, 0.7}}, lying},
          {"leaning disc on plane", Cylinder{{0.0, 0.0, 1.0}, {0.2, 0.0, 1.05}, 0.9}, floor}};
}

Eigen::Isometry3d small_motion(double size) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translate(size * Vector3(0.4, -0.3, 0.2));
  result.rotate(Eigen::AngleAxisd(size, Vector3(0.5, 1.0, -0.7).normalized()));
  return result;
}

// The deepest contact point of two shapes.
TouchingPoint deepest_point(const Shape& first, const Shape& second) {
  TouchingPoint best;
  best.gap = kInfinity;
  for (const TouchingPoint& point : touching_points(first, second, kInfinity)) {
    if (point.gap < best.gap) best = point;
  }
  return best;
}

// Two moved features touch where the moved shapes do: an independent search.
TEST(TouchingFeature, FollowsTheShapes) {
  for (const RoundPair& pair : round_pairs()) {
    const TouchingPoint at = deepest_point(pair.first, pair.second);
    const auto first = touching_feature(pair.first, at.on_first, -at.normal);
    const auto second = touching_feature(pair.second, at.on_second, at.normal);
    for (const double size : {0.0, 0.02, 0.1}) {
      const auto expected = deepest_point(moved(pair.first, small_motion(size)), pair.second);
      const auto place = turned_place(first.moved(small_motion(size)), second, at.normal);
      EXPECT_NEAR(place.gap, expected.gap, 1e-9) << pair.name << ", " << size;
      EXPECT_LT((place.normal - expected.normal).norm(), 1e-6) << pair.name << ", " << size;
      EXPECT_LT((place.on_first - expected.on_first).norm(), 1e-6) << pair.name << ", " << size;
      EXPECT_LT((place.on_second - expected.on_second).norm(), 1e-6) << pair.name << ", " << size;
    }
  }
}

// The gap changes with the velocity of the two points of contact along the normal, by central
// differences.
TEST(TouchingFeature, GapHasTheNormalAsGradient) {
  constexpr double kSmall = 1e-5;
  for (const RoundPair& pair : round_pairs()) {
    const TouchingPoint at = deepest_point(pair.first, pair.second);
    const auto first = touching_feature(pair.first, at.on_first, -at.normal);
    const auto second = touching_feature(pair.second, at.on_second, at.normal);
    const double after = turned_place(first.moved(small_motion(kSmall)), second, at.normal).gap;
    const double before = turned_place(first.moved(small_motion(-kSmall)), second, at.normal).gap;
    const Vector3 moved = small_motion(kSmall) * at.on_first - small_motion(-kSmall) * at.on_first;
    EXPECT_NEAR((after - before) / (2.0 * kSmall), at.normal.dot(moved) / (2.0 * kSmall), 1e-6)
        << pair.name;
  }
}

// Seen along a fixed normal, the gap is that of the farthest points.
TEST(TouchingFeature, FixedNormalKeepsTheTangentPlane) {
  const Sphere ball{{0.0, 0.0, 2.0}, 1.0}, other{{0.0, 0.0, 0.0}, 1.0};
  const auto first = touching_feature(ball, {0.0, 0.0, 1.0}, -Vector3::UnitZ());
  const auto second = touching_feature(other, {0.0, 0.0, 1.0}, Vector3::UnitZ());
  Eigen::Isometry3d aside = Eigen::Isometry3d::Identity();
  aside.translate(Vector3(0.5, 0.0, 0.0));
  EXPECT_NEAR(touching_place(first.moved(aside), second, Vector3::UnitZ()).gap, 0.0, 1e-15);
  EXPECT_NEAR(turned_place(first.moved(aside), second, Vector3::UnitZ()).gap,
              std::hypot(0.5, 2.0) - 2.0, 1e-15);
}

}  // namespace
}  // namespace sinew::collision
