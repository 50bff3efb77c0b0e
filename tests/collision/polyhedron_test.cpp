#include "sinew/collision/polyhedron.hpp"

#include <algorithm>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/collision/point_query.hpp"
#include "sinew/collision/shape.hpp"
#include "sinew/collision/touching_points.hpp"

#include "support/error_kind.hpp"
#include "surfaces.hpp"

namespace sinew::collision {
namespace {

using namespace testing;
using sinew::testing::kind_of;

Points random_points(int count) {
  Random random(17);
  std::vector<Vector3> points;
  for (int k = 0; k < count; ++k) points.push_back(random_point(random, 0.5));
  return to_points(points);
}

// Converts the hull to a triangle surface over the hull's corners.
TestSurface surface_of(const Polyhedron& hull) {
  TestSurface surface;
  surface.nodes = to_points(hull.corners());
  for (const Polyhedron::Face& face : hull.faces()) {
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found = std::ranges::find(hull.corners(), face.corners[k]);
      triangle[k] = static_cast<NodeId>(found - hull.corners().begin());
    }
    surface.triangles.push_back(triangle);
  }
  return surface;
}

ConvexSolid box_of_corners(const Vector3& half, const Vector3& origin, const Matrix3& axes) {
  std::vector<Vector3> corners;
  for (int k = 0; k < 8; ++k) {
    corners.push_back(half.cwiseProduct(Vector3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
  }
  return {std::make_shared<const Polyhedron>(to_points(corners)), origin, axes};
}

TEST(Polyhedron, IsTheHullOfItsPoints) {
  const Points points = random_points(60);
  const Polyhedron hull(points);
  EXPECT_EQ(hull.faces().size(), 2 * hull.corners().size() - 4);  // Euler's formula
  for (const Polyhedron::Face& face : hull.faces()) {
    EXPECT_LE((points * face.normal).maxCoeff(), face.offset + 1e-14);
    for (const Vector3& corner : face.corners) {
      EXPECT_NEAR(face.normal.dot(corner), face.offset, 1e-14);
    }
  }
  EXPECT_TRUE(surface_of(hull).topology()->closed());
}

TEST(Polyhedron, RefusesPointsWithoutVolume) {
  Points points = random_points(10);
  points.col(1).setZero();
  EXPECT_EQ(kind_of([&] { Polyhedron{points}; }), ErrorKind::zero_volume);
  EXPECT_EQ(kind_of([] { Polyhedron{random_points(3)}; }), ErrorKind::zero_volume);
}

TEST(Polyhedron, IsAsFarAsItsSurface) {
  Random random(18);
  const auto hull = std::make_shared<const Polyhedron>(random_points(40));
  const ConvexSolid solid{hull, {0.1, -0.2, 0.3}, random_rotation(random)};
  const TestSurface surface = surface_of(*hull);
  ThreadPool pool;
  SurfaceTree tree(surface.topology());
  tree.move(surface.nodes, pool);
  for (int trial = 0; trial < 500; ++trial) {
    const Vector3 x = random_point(random, 1.2);
    const Vector3 local = solid.axes.transpose() * (x - solid.origin);
    const double far = nearest_on_surface(tree, local).distance;
    EXPECT_NEAR(distance(solid, x).gap, winding_number(tree, local) == 1 ? -far : far, 1e-14);
  }
}

TEST(Polyhedron, OfABoxIsTheBox) {
  Random random(19);
  const Vector3 half(0.5, 0.7, 0.3), centre(0.1, 0.2, 0.3);
  const Matrix3 axes = random_rotation(random);
  const ConvexSolid solid = box_of_corners(half, centre, axes);
  const OrientedBox box{centre, axes, half};
  for (int trial = 0; trial < 500; ++trial) {
    const Vector3 x = random_point(random, 1.2);
    const ShapeDistance ours = distance(solid, x), theirs = distance(box, x);
    EXPECT_NEAR(ours.gap, theirs.gap, 1e-14);
    if (theirs.gap > 1e-3) {
      EXPECT_LT((ours.normal - theirs.normal).norm(), 1e-11);
    }
  }
}

TEST(Polyhedron, StandsOnAPlaneAsABoxDoes) {
  const Vector3 half(0.5, 0.1, 0.3);
  for (const double gap : {0.01, 0.0, -0.01}) {
    for (const double lean : {0.0, 1e-3}) {
      const Matrix3 turn =
          (Eigen::AngleAxisd(lean, Vector3::UnitY()) * Eigen::AngleAxisd(0.4, Vector3::UnitZ()))
              .toRotationMatrix();
      const Vector3 centre(0.2, 0.3, 0.3 + gap);
      const auto ours = touching_points(box_of_corners(half, centre, turn), Plane{}, 0.02);
      const auto theirs = touching_points(OrientedBox{centre, turn, half}, Plane{}, 0.02);
      ASSERT_EQ(ours.size(), 4U);
      ASSERT_EQ(theirs.size(), 4U);
      for (const TouchingPoint& one : ours) {
        const bool found = std::ranges::any_of(theirs, [&](const TouchingPoint& other) {
          return (one.on_first - other.on_first).norm() < 1e-12 &&
                 (one.on_second - other.on_second).norm() < 1e-12 &&
                 std::abs(one.gap - other.gap) < 1e-12;
        });
        EXPECT_TRUE(found) << one.on_first.transpose();
      }
    }
  }
}

TEST(Polyhedron, OfManyCornersStandsOnItsWholeRim) {
  std::vector<Vector3> corners;
  for (int k = 0; k < 200; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 200;
    for (const double z : {0.0, 0.1}) corners.emplace_back(std::cos(angle), std::sin(angle), z);
  }
  const ConvexSolid drum{std::make_shared<const Polyhedron>(to_points(corners)), Vector3::Zero(),
                         Matrix3::Identity()};
  const TouchingPoints points = touching_points(drum, Plane{}, 1e-3);
  ASSERT_EQ(points.size(), TouchingPoints::kMax);
  for (int d = 0; d < 16; ++d) {  // the points support it in each direction
    const double angle = 2.0 * std::numbers::pi * d / 16;
    double farthest = 0.0;
    for (const TouchingPoint& at : points) {
      farthest =
          std::max(farthest, at.on_first[0] * std::cos(angle) + at.on_first[1] * std::sin(angle));
      EXPECT_NEAR(at.on_first[2], 0.0, 1e-15);
    }
    EXPECT_GT(farthest, 0.8);
  }
}

TEST(Polyhedron, HasNoContactWithBoundedShapesYet) {
  const ConvexSolid box = box_of_corners({1, 1, 1}, {0, 0, 0}, Matrix3::Identity());
  EXPECT_EQ(kind_of([&] {
              touching_points(box, Sphere{{0, 0, 3}, 1.0}, 0.1);
            }),
            ErrorKind::not_in_this_version);
}

}  // namespace
}  // namespace sinew::collision
