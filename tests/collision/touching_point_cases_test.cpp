// Touching points in cases where they are known: standing and lying boxes, cylinders and capsules.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/collision/touching_points.hpp"

#include "shape_pairs.hpp"

namespace sinew::collision {
namespace {

using namespace testing;

// Checks that the points on the second shape are exactly those of `expected`.
void expect_points(const TouchingPoints& points, const std::vector<Vector3>& expected, double gap,
                   const Vector3& normal = Vector3::UnitZ()) {
  EXPECT_EQ(points.size(), expected.size());
  for (const Vector3& point : expected) {
    EXPECT_TRUE(std::any_of(points.begin(), points.end(), [&](const TouchingPoint& at) {
      return (at.on_second - point).norm() < 1e-9;
    })) << point.transpose();
  }
  for (const TouchingPoint& at : points) {
    EXPECT_NEAR(at.gap, gap, 1e-12);
    EXPECT_LE((at.normal - normal).norm(), 1e-12);
  }
}

Matrix3 about(const Vector3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

constexpr double kGaps[] = {0.0, 1e-13, -1e-13, 1e-6, -1e-6, 1e-3, -1e-3};
const OrientedBox kTable{{0.0, 0.0, -0.5}, Matrix3::Identity(), {1.0, 1.0, 0.5}};

TEST(TouchingPointCases, OfABoxOnATableAreItsCorners) {
  const Vector3 half(0.2, 0.3, 0.1);
  for (const double gap : kGaps) {
    for (const double angle : {0.0, 0.3, 1.0}) {
      const Matrix3 turn = about(Vector3::UnitZ(), angle);
      std::vector<Vector3> corners;
      for (const double x : {-0.2, 0.2}) {
        for (const double y : {-0.3, 0.3}) corners.push_back(turn * Vector3(x, y, 0.0));
      }
      const OrientedBox box{{0.0, 0.0, 0.1 + gap}, turn, half};
      expect_points(touching_points(box, kTable, 0.01), corners, gap);
      expect_points(touching_points(box, Plane{}, 0.01), corners, gap);
    }
  }
}

TEST(TouchingPointCases, OfTurnedBoxesAreThoseOfTheOctagon) {
  const OrientedBox lower{Vector3::Zero(), Matrix3::Identity(), {0.5, 0.5, 0.5}};
  const double near = 0.5 * (std::sqrt(2.0) - 1.0);  // from a corner to a side's middle
  std::vector<Vector3> octagon;
  for (const double side : {-0.5, 0.5}) {
    for (const double along : {-near, near}) {
      octagon.push_back({side, along, 0.5});
      octagon.push_back({along, side, 0.5});
    }
  }
  for (const double gap : kGaps) {
    const OrientedBox upper{
        {0.0, 0.0, 1.0 + gap}, about(Vector3::UnitZ(), std::numbers::pi / 4.0), {0.5, 0.5, 0.5}};
    expect_points(touching_points(upper, lower, 0.01), octagon, gap);
  }
}

TEST(TouchingPointCases, OfEqualBoxesOnEachOtherAreTheCorners) {
  const OrientedBox lower{Vector3::Zero(), Matrix3::Identity(), {0.5, 0.5, 0.5}};
  for (const double gap : kGaps) {
    const OrientedBox upper{{0.0, 0.0, 1.0 + gap}, Matrix3::Identity(), {0.5, 0.5, 0.5}};
    expect_points(touching_points(upper, lower, 0.01),
                  {{0.5, 0.5, 0.5}, {-0.5, 0.5, 0.5}, {-0.5, -0.5, 0.5}, {0.5, -0.5, 0.5}}, gap);
  }
}

TEST(TouchingPointCases, OfCrossingEdgesAreTheNearestPair) {
  // Both stand on an edge, and the edges cross at a right angle.
  const Matrix3 on_edge = about(Vector3::UnitX(), std::numbers::pi / 4.0);
  const double high = 0.5 * std::sqrt(2.0);
  for (const double gap : kGaps) {
    const OrientedBox lower{Vector3::Zero(), on_edge, {0.5, 0.5, 0.5}};
    const OrientedBox upper{{0.1, 0.0, 2.0 * high + gap},
                            about(Vector3::UnitZ(), std::numbers::pi / 2.0) * on_edge,
                            {0.5, 0.5, 0.5}};
    expect_points(touching_points(upper, lower, std::max(0.0, gap) + 1e-9), {{0.1, 0.0, high}},
                  gap);
  }
}

TEST(TouchingPointCases, OfAnEdgeOnATableAreItsEnds) {
  for (const double gap : kGaps) {
    const double high = 0.2 * std::sqrt(2.0);
    const OrientedBox box{
        {0, 0, high + gap}, about(Vector3::UnitX(), std::numbers::pi / 4.0), {0.5, 0.2, 0.2}};
    expect_points(touching_points(box, kTable, 0.01), {{-0.5, 0, 0}, {0.5, 0, 0}}, gap);
    expect_points(touching_points(box, Plane{}, 0.01), {{-0.5, 0, 0}, {0.5, 0, 0}}, gap);
  }
}

TEST(TouchingPointCases, OfWhatLiesAreItsEnds) {
  const Shape table = kTable, floor = Plane{};
  for (const double gap : kGaps) {
    const Vector3 from(-0.3, 0.0, 0.1 + gap), to(0.3, 0.0, 0.1 + gap);
    for (const Shape& lying : {Shape(Capsule{from, to, 0.1}), Shape(Cylinder{from, to, 0.1})}) {
      for (const Shape& below : {table, floor}) {
        expect_points(touching_points(lying, below, 0.01), {{-0.3, 0, 0}, {0.3, 0, 0}}, gap);
      }
      // The lying shape is longer than the table is wide.
      const OrientedBox bar{{0.0, 0.0, -0.1}, Matrix3::Identity(), {0.05, 0.2, 0.1}};
      expect_points(touching_points(lying, bar, 0.01), {{-0.05, 0, 0}, {0.05, 0, 0}}, gap);
      // Parallel to another shape of either kind, half of it beyond the end.
      const Vector3 lower_from(0.0, 0.0, -0.2), lower_to(0.8, 0.0, -0.2);
      for (const Shape& below : {Shape(Capsule{lower_from, lower_to, 0.2}),
                                 Shape(Cylinder{lower_from, lower_to, 0.2})}) {
        expect_points(touching_points(lying, below, 0.01), {{0, 0, 0}, {0.3, 0, 0}}, gap);
      }
    }
  }
}

TEST(TouchingPointCases, OfAStandingCylinderAreFourOfItsRim) {
  Random random(61);
  for (const double gap : kGaps) {
    const std::vector<Vector3> rim = {{0.2, 0, 0}, {-0.2, 0, 0}, {0, 0.2, 0}, {0, -0.2, 0}};
    for (int trial = 0; trial < 10; ++trial) {
      // Noise in the axis does not change the points.
      const Cylinder can{Vector3(0, 0, gap), Vector3(0, 0, 0.5 + gap) + random_point(random, 1e-13),
                         0.2};
      expect_points(touching_points(can, kTable, 0.01), rim, gap);
      expect_points(touching_points(can, Plane{}, 0.01), rim, gap);
      const Cylinder lower{{0, 0, -0.5}, {0, 0, 0}, 0.3};
      expect_points(touching_points(can, lower, 0.01), rim, gap);
      expect_points(touching_points(can, Cylinder{{-1, 0, -0.3}, {1, 0, -0.3}, 0.3}, 0.01),
                    {{-0.2, 0, 0}, {0.2, 0, 0}}, gap);
    }
  }
}

TEST(TouchingPointCases, OfALeaningCylinderHaveItsLowestPoint) {
  for (const double tilt : {1e-7, 1e-4, 0.01, 0.3, 1.0, 1.5}) {
    for (const double way : {0.0, 0.4, 2.0}) {
      const Vector3 axis(std::sin(tilt) * std::cos(way), std::sin(tilt) * std::sin(way),
                         std::cos(tilt));
      const double lowest = -0.2 * std::sin(tilt);
      const Vector3 end(0.0, 0.0, 0.001);
      for (const Shape& below : {Shape(kTable), Shape(Plane{})}) {
        const TouchingPoints points =
            touching_points(Cylinder{end, end + 0.5 * axis, 0.2}, below, 0.01);
        EXPECT_NEAR(least_gap(points), 0.001 + lowest, 1e-13);
      }
    }
  }
}

TEST(TouchingPointCases, OfStackedCylindersSpanTheirCommonPart) {
  // Equal cylinders, offset by half a radius: the points span the lens that both cover, including
  // its tips.
  const Cylinder lower{{0, 0, -1}, {0, 0, 0}, 0.2}, upper{{0.1, 0, 0}, {0.1, 0, 1}, 0.2};
  const TouchingPoints points = touching_points(upper, lower, 0.01);
  Vector3 low = Vector3::Constant(kInfinity), high = -low;
  for (const TouchingPoint& at : points) {
    EXPECT_NEAR(at.gap, 0.0, 1e-14);
    low = low.cwiseMin(at.on_first);
    high = high.cwiseMax(at.on_first);
  }
  EXPECT_NEAR(high[1], 0.2 * std::sqrt(1.0 - 0.25 * 0.25), 1e-12);
  EXPECT_NEAR(low[1], -high[1], 1e-12);
  EXPECT_NEAR(low[0], -0.1, 1e-12);
  EXPECT_NEAR(high[0], 0.2, 1e-12);
}

TEST(TouchingPointCases, OfARoundThingOnAnEdge) {
  // A capsule along a box's edge, at 45 degrees, touches at both its ends; a ball there touches at
  // one point.
  const Vector3 edge(0.0, 1.0, 0.0), out = Vector3(0.0, 1.0, 1.0).normalized();
  for (const double gap : {1e-9, 1e-6, 1e-3, -1e-3}) {
    const Vector3 centre = edge + (0.1 + gap) * out;
    const Capsule capsule{centre - 0.3 * Vector3::UnitX(), centre + 0.3 * Vector3::UnitX(), 0.1};
    expect_points(touching_points(capsule, kTable, 0.01), {{-0.3, 1.0, 0.0}, {0.3, 1.0, 0.0}}, gap,
                  out);
    expect_points(touching_points(Sphere{centre, 0.1}, kTable, 0.01), {{0.0, 1.0, 0.0}}, gap, out);
  }
}

// The gap of the point with a given feature; infinite if there is none.
double gap_at(const TouchingPoints& points, int feature) {
  for (const TouchingPoint& at : points) {
    if (at.feature == feature) return at.gap;
  }
  return kInfinity;
}

TEST(TouchingPointCases, KeepTheirFeaturesAndChangeTheirGapsLittle) {
  // Small rotations of shapes that stand or lie on a table.
  Random random(62);
  const std::vector<Shape> shapes = {
      OrientedBox{{0, 0, 0.1}, about(Vector3::UnitZ(), 0.3), {0.2, 0.3, 0.1}},
      Cylinder{{0, 0, 0}, {0, 0, 0.5}, 0.2}, Cylinder{{-0.3, 0, 0.1}, {0.3, 0, 0.1}, 0.1},
      Capsule{{-0.3, 0, 0.1}, {0.3, 0, 0.1}, 0.1}};
  for (const Shape& shape : shapes) {
    for (const Shape& below : {Shape(kTable), Shape(Plane{})}) {
      const TouchingPoints there = touching_points(shape, below, 0.01);
      for (const double turn : {1e-12, 1e-9, 1e-7, 1e-5, 1e-3}) {
        for (int trial = 0; trial < 20; ++trial) {
          const Vector3 axis = random_point(random).normalized();
          const TouchingPoints after =
              touching_points(moved(shape, about(axis, turn), Vector3::Zero()), below, 0.01);
          for (const TouchingPoint& at : there) {
            EXPECT_NEAR(gap_at(after, at.feature), at.gap, turn + 1e-14) << at.feature;
          }
          EXPECT_GE(least_gap(after), least_gap(there) - turn - 1e-14);
        }
      }
    }
  }
}

TEST(TouchingPointCases, TakeShapesThatAreInEachOther) {
  for (int i = 1; i < kKinds; ++i) {
    for (int j = 1; j < kKinds; ++j) {
      Random random(63);
      const Shape first = random_shape(random, i), second = random_shape(random, j);
      const TouchingPoints points = touching_points(first, second, 0.0);
      ASSERT_FALSE(points.empty()) << i << ' ' << j;
      const TouchingPoint& at = deepest(points);
      EXPECT_NEAR(push({first, second}, at.normal), -at.gap, 1e-9) << i << ' ' << j;
      // A shape with itself, in the same pose.
      const TouchingPoints own = touching_points(first, first, 0.0);
      ASSERT_FALSE(own.empty());
      EXPECT_NEAR(push({first, first}, deepest(own).normal), -least_gap(own), 1e-9) << i;
    }
  }
  EXPECT_TRUE(touching_points(Plane{}, Plane{}, 1.0).empty());
}

// Cubes of equal size whose sides are flush up to noise: only the faces that meet take part, not
// the sides seen edge-on.
TEST(TouchingPointCases, FlushCubesTouchWithFacesAlone) {
  const Vector3 half = Vector3::Constant(0.01);
  for (int trial = 0; trial < 1000; ++trial) {
    std::srand(static_cast<unsigned>(trial));
    const auto noise = [&](double size) { return Vector3(size * Vector3::Random()); };
    const auto cube = [&](double height) {
      const Vector3 turn = noise(1e-9);
      const Matrix3 axes = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
      return OrientedBox{Vector3(0.0, 0.0, height) + noise(1e-10), axes, half};
    };
    const TouchingPoints found = touching_points(cube(0.03), cube(0.01), kInfinity);
    ASSERT_GE(found.size(), 4U);
    for (const TouchingPoint& at : found) {
      EXPECT_NEAR(at.gap, 0.0, 1e-9);
      EXPECT_NEAR(at.normal.z(), 1.0, 1e-9);
      EXPECT_NEAR(at.on_first.z(), 0.02, 1e-9);
      EXPECT_NEAR(at.on_second.z(), 0.02, 1e-9);
    }
  }
}

}  // namespace
}  // namespace sinew::collision
