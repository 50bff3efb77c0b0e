#include "sinew/collision/approach.hpp"

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace sinew::collision {
namespace {

std::vector<Shape> shapes() {
  const Matrix3 axes =
      Eigen::AngleAxisd(0.7, Vector3(0.2, 0.5, 0.7).normalized()).toRotationMatrix();
  Points wedge(6, 3);
  wedge << 0, 0, 0, 0.03, 0, 0, 0, 0.02, 0, 0.03, 0.02, 0, 0.01, 0.01, 0.02, 0.02, 0.01, 0.025;
  return {Plane{{0.1, -0.2, 0.05}, Vector3(0.3, -0.4, 0.8).normalized()},
          Sphere{{0.02, 0.01, -0.03}, 0.02},
          Capsule{{-0.01, 0.0, 0.0}, {0.03, 0.02, -0.01}, 0.005},
          Cylinder{{-0.01, 0.0, 0.0}, {0.03, 0.02, -0.01}, 0.015},
          OrientedBox{{0.01, -0.01, 0.0}, axes, {0.02, 0.01, 0.03}},
          ConvexSolid{std::make_shared<const Polyhedron>(wedge), {0.01, -0.01, 0.0}, axes}};
}

// Compares with a dense sampling of the path: the first sample inside the shape, or the nearest
// sample if none is inside.
TEST(Approach, IsTheFirstMeetingOrTheNearestPoint) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.06, 0.06);
  constexpr int kParts = 4000;
  int met = 0, missed = 0, between = 0;
  for (const Shape& surface : shapes()) {
    for (int trial = 0; trial < 400; ++trial) {
      const Vector3 from(coordinate(random), coordinate(random), coordinate(random));
      const Vector3 to(coordinate(random), coordinate(random), coordinate(random));
      if (distance(surface, from).gap <= 0.0) continue;
      double least = distance(surface, from).gap, first = -1.0, at = 0.0;
      for (int k = 1; k <= kParts && first < 0.0; ++k) {
        const double share = static_cast<double>(k) / kParts;
        const double gap = distance(surface, from + share * (to - from)).gap;
        if (gap < 0.0) first = share;
        if (gap < least) at = share;
        least = std::min(least, gap);
      }
      const ShapeApproach found = approach(surface, from, to);
      const double share = (found.at - from).norm() / (to - from).norm();
      const Vector3 normal = found.distance.normal;
      if (std::abs(least) < 1e-6) continue;  // grazes
      EXPECT_EQ(found.meets, first >= 0.0);
      if (found.meets) {
        ++met;
        EXPECT_NEAR(share, first, 1.0 / kParts + 1e-9);
        EXPECT_GE(found.distance.gap, -1e-14);
        EXPECT_LT(normal.dot(to - found.at), 0.0);
      } else {
        ++missed;
        between += share > 1e-6 && share < 1.0 - 1e-6 ? 1 : 0;
        EXPECT_LE(found.distance.gap, least + 1e-12);
        EXPECT_NEAR(found.distance.gap, least, 1e-6);
        if (least > 1e-3) {
          EXPECT_NEAR(share, at, 0.01);
        }
        EXPECT_GT(found.distance.gap + normal.dot(to - found.at), 0.0);  // stays above the plane
      }
      EXPECT_GE(found.distance.gap + normal.dot(from - found.at), -1e-14);
      // The tangent plane supports the solid: no point of the solid lies beyond it.
      const Vector3 foot = found.at - (found.distance.gap - 1e-9) * normal;
      EXPECT_GE(distance(surface, foot + 0.02 * normal.unitOrthogonal()).gap, 0.0);
    }
  }
  EXPECT_GT(met, 40);
  EXPECT_GT(missed, 300);
  EXPECT_GT(between, 50);
}

TEST(Approach, OfPointsThatRestTouchOrLeave) {
  const Sphere ball{Vector3::Zero(), 1.0};
  const Vector3 top(0.0, 0.0, 1.0);
  const ShapeApproach rests = approach(ball, top, top);
  EXPECT_EQ(rests.at, top);
  EXPECT_FALSE(rests.meets);
  EXPECT_FALSE(approach(ball, top, {0.0, 0.0, 2.0}).meets);  // moves away
  EXPECT_FALSE(approach(ball, top, {1.0, 0.0, 1.0}).meets);  // along the tangent
  EXPECT_TRUE(approach(ball, top, {1.0, 0.0, 0.99}).meets);  // into it at once
  EXPECT_EQ(approach(ball, top, {0.0, 0.0, -3.0}).at, top);  // does not exit at the other side
  EXPECT_FALSE(approach(ball, {0.0, 0.0, 0.5}, {0.0, 0.0, 2.0}).meets);  // starts inside, moves out
  const ShapeApproach inside = approach(ball, {0.0, 0.0, 0.5}, {0.0, 0.0, 0.1});
  EXPECT_TRUE(inside.meets);
  EXPECT_DOUBLE_EQ(inside.distance.gap, -0.5);
}

}  // namespace
}  // namespace sinew::collision
