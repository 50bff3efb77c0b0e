#include "sinew/collision/touching_points.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "shape_pairs.hpp"

namespace sinew::collision {
namespace {

using namespace testing;

// An independent distance: alternating projections onto both solids, with Nesterov momentum on the
// point of the first. The function is convex.
Vector3 projected(const Shape& shape, const Vector3& point) {
  const ShapeDistance at = distance(shape, point);
  return at.gap > 0.0 ? at.nearest : point;
}
double distance_by_projection(const Shape& first, const Shape& second) {
  Vector3 x = projected(first, Vector3::Zero()), ahead = x;
  double momentum = 1.0, least = kInfinity;
  for (int k = 0; k < 20000; ++k) {
    const Vector3 next = projected(first, projected(second, ahead));
    const double following = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum * momentum));
    const bool restarts = (ahead - next).dot(next - x) > 0.0;
    ahead = restarts ? next : (next + (momentum - 1.0) / following * (next - x)).eval();
    momentum = restarts ? 1.0 : following;
    const double step = (next - x).norm();
    x = next;
    least = std::min(least, (x - projected(second, x)).norm());
    if (step < 1e-13 && k > 10) break;
  }
  return least;
}

TEST(TouchingPoints, HaveTheDistanceOfShapesThatAreApart) {
  int compared = 0;
  with_every_pair(51, 400, [&](const Pair& pair) {
    const double far = distance_by_projection(pair.first, pair.second);
    if (far < 1e-5) return;
    ++compared;
    const TouchingPoints points = touching_points(pair.first, pair.second, 10.0);
    ASSERT_FALSE(points.empty());
    EXPECT_NEAR(least_gap(points), far, 2e-8);
    EXPECT_TRUE(touching_points(pair.first, pair.second, 0.999 * far).empty());
  });
  EXPECT_GT(compared, 2500);
}

// Checks that a point is on the shape. A leaning capsule touches with the balls at its ends, and
// the point of the upper one may be inside it.
void expect_on(const Shape& shape, const Vector3& point) {
  const double out = distance(shape, point).gap;
  EXPECT_LE(out, 1e-7);  // iterated points have half the digits of the gap
  if (!std::holds_alternative<Capsule>(shape)) {
    EXPECT_GE(out, -1e-7);
  }
}

TEST(TouchingPoints, AreOnBothShapes) {
  int apart = 0, overlapping = 0;
  with_every_pair(52, 300, [&](const Pair& pair) {
    const TouchingPoints points = touching_points(pair.first, pair.second, 0.1);
    if (points.empty()) return;
    const double least = least_gap(points);
    ++(least > 0.0 ? apart : overlapping);
    for (const TouchingPoint& at : points) {
      expect_on(pair.first, at.on_first);
      expect_on(pair.second, at.on_second);
      EXPECT_NEAR(at.normal.norm(), 1.0, 1e-14);
      EXPECT_NEAR(at.normal.dot(at.on_first - at.on_second), at.gap, 1e-14);
      EXPECT_LE((at.on_first - at.on_second - at.gap * at.normal).norm(), 2e-7);
      EXPECT_LE(at.gap, 0.1);
      for (const TouchingPoint& other : points) {
        EXPECT_TRUE(&at == &other || at.feature != other.feature) << at.feature;
      }
    }
  });
  EXPECT_GT(apart, 200);
  EXPECT_GT(overlapping, 1000);
}

TEST(TouchingPoints, MovedByTheLeastGapShapesAreFree) {
  with_every_pair(53, 300, [&](const Pair& pair) {
    const TouchingPoints points = touching_points(pair.first, pair.second, 0.0);
    if (points.empty()) return;
    const TouchingPoint& at = deepest(points);
    EXPECT_NEAR(push(pair, at.normal), -at.gap, 2e-9) << at.feature;
  });
}

TEST(TouchingPoints, OverlapByTheLeastPush) {
  // No other direction separates them sooner; tries random directions, and smaller and smaller
  // rotations of the best one.
  Random random(54);
  int compared = 0;
  with_every_pair(55, 800, [&](const Pair& pair) {
    if (std::holds_alternative<Plane>(pair.first)) return;
    const TouchingPoints points = touching_points(pair.first, pair.second, 0.0);
    if (points.empty() || least_gap(points) < -0.03) return;
    ++compared;
    Vector3 best = deepest(points).normal;
    double least = push(pair, best);
    for (int k = 0; k < 4000; ++k) {
      const double turn = k < 2000 ? 10.0 : std::pow(10.0, -(k % 8));
      const Vector3 way = (best + turn * random_point(random)).normalized();
      if (push(pair, way) >= least) continue;
      least = push(pair, way);
      best = way;
    }
    EXPECT_GE(least, -least_gap(points) - 1e-9) << deepest(points).feature;
  });
  EXPECT_GT(compared, 100);
}

TEST(TouchingPoints, AreTheSameWhereShapesChangePlaces) {
  with_every_pair(56, 200, [&](const Pair& pair) {
    const TouchingPoints there = touching_points(pair.first, pair.second, 0.02);
    const TouchingPoints back = touching_points(pair.second, pair.first, 0.02);
    ASSERT_EQ(there.size(), back.size());
    for (const TouchingPoint& at : there) {
      EXPECT_TRUE(std::any_of(back.begin(), back.end(),
                              [&](const TouchingPoint& other) {
                                return std::abs(at.gap - other.gap) < 1e-9 &&
                                       (at.normal + other.normal).norm() < 1e-7 &&
                                       (at.on_first - other.on_second).norm() < 1e-7;
                              }))
          << at.feature << " gap " << at.gap << ' ' << least_gap(back);
    }
  });
}

TEST(TouchingPoints, GoWithARigidMotion) {
  Random random(57);
  with_every_pair(58, 200, [&](const Pair& pair) {
    const Matrix3 turn = random_rotation(random);
    const Vector3 shift = random_point(random);
    const TouchingPoints here = touching_points(pair.first, pair.second, 0.02);
    const TouchingPoints there =
        touching_points(moved(pair.first, turn, shift), moved(pair.second, turn, shift), 0.02);
    if (here.empty()) return;
    ASSERT_FALSE(there.empty());

    const bool rims =
        std::holds_alternative<Cylinder>(pair.second) &&
        (std::holds_alternative<Plane>(pair.first) || std::holds_alternative<Cylinder>(pair.first));
    if (rims) return;  // the four points of a rim follow the world axes
    ASSERT_EQ(here.size(), there.size());
    EXPECT_NEAR(least_gap(here), least_gap(there), 2e-9);
    for (const TouchingPoint& at : here) {
      EXPECT_TRUE(std::any_of(there.begin(), there.end(), [&](const TouchingPoint& other) {
        return (turn * at.on_first + shift - other.on_first).norm() < 1e-6 &&
               at.feature == other.feature;
      })) << at.feature;
    }
  });
}

}  // namespace
}  // namespace sinew::collision
