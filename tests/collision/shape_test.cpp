#include "sinew/collision/shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/collision/point_query.hpp"

#include "support/error_kind.hpp"
#include "surfaces.hpp"

namespace sinew::collision {
namespace {

using namespace testing;
using sinew::testing::kind_of;

struct Sample {
  const char* name;
  Shape shape;
};

constexpr double kOctahedron = 0.8;  // m, from centre to corner

std::shared_ptr<const Polyhedron> octahedron() {
  Points corners(6, 3);
  corners << kOctahedron * Matrix3::Identity(), -kOctahedron * Matrix3::Identity();
  return std::make_shared<const Polyhedron>(corners);
}

std::vector<Sample> samples() {
  Random random(41);
  return {{"plane", Plane{{0.1, 0.2, 0.3}, Vector3(1, 2, 3).normalized()}},
          {"sphere", Sphere{{0.1, -0.2, 0.3}, 0.7}},
          {"capsule", Capsule{{-0.4, 0.1, 0.0}, {0.5, 0.3, -0.2}, 0.4}},
          {"cylinder", Cylinder{{-0.4, 0.1, 0.0}, {0.5, 0.3, -0.2}, 0.6}},
          {"box", OrientedBox{{0.1, 0.2, 0.0}, random_rotation(random), {0.5, 0.7, 0.3}}},
          {"octahedron", ConvexSolid{octahedron(), {0.1, 0.0, 0.2}, random_rotation(random)}}};
}

// Point-in-solid tests, from the definitions of the solids.
bool holds(const Plane& plane, const Vector3& x) { return plane.normal.dot(x - plane.point) < 0.0; }
bool holds(const Sphere& sphere, const Vector3& x) {
  return (x - sphere.centre).norm() < sphere.radius;
}
bool holds(const Capsule& capsule, const Vector3& x) {
  for (int k = 0; k <= 4000; ++k) {
    const Vector3 centre = capsule.from + k / 4000.0 * (capsule.to - capsule.from);
    if ((x - centre).norm() < capsule.radius) return true;
  }
  return false;
}
bool holds(const Cylinder& cylinder, const Vector3& x) {
  const Vector3 axis = cylinder.to - cylinder.from;
  return axis.dot(x - cylinder.from) > 0.0 && axis.dot(x - cylinder.to) < 0.0 &&
         axis.cross(x - cylinder.from).norm() < cylinder.radius * axis.norm();
}
bool holds(const OrientedBox& box, const Vector3& x) {
  return ((box.axes.transpose() * (x - box.centre)).cwiseAbs().array() < box.half_size.array())
      .all();
}
bool holds(const ConvexSolid& solid, const Vector3& x) {
  return (solid.axes.transpose() * (x - solid.origin)).lpNorm<1>() < kOctahedron;
}

TEST(ShapeDistance, TellsInsideFromOutside) {
  Random random(42);
  for (const Sample& sample : samples()) {
    for (int trial = 0; trial < 300; ++trial) {
      const Vector3 x = random_point(random, 1.5);
      const double far = distance(sample.shape, x).gap;
      if (std::abs(far) < 1e-6) continue;
      const bool inside = std::visit([&](const auto& own) { return holds(own, x); }, sample.shape);
      EXPECT_EQ(far < 0.0, inside) << sample.name;
    }
  }
}

TEST(ShapeDistance, IsTheLeastOneToTheSurface) {
  // The nearest point lies on the surface at the reported distance, and no other sampled point of
  // the surface is nearer.
  Random random(43);
  for (const Sample& sample : samples()) {
    std::vector<Vector3> surface;
    for (int k = 0; k < 2000; ++k) {
      const Vector3 x = random_point(random, 1.5);
      const ShapeDistance at = distance(sample.shape, x);
      EXPECT_NEAR(distance(sample.shape, at.nearest).gap, 0.0, 1e-14) << sample.name;
      EXPECT_NEAR((x - at.nearest).norm(), std::abs(at.gap), 1e-14);
      EXPECT_NEAR(at.normal.norm(), 1.0, 1e-14);
      EXPECT_LE((at.nearest + at.gap * at.normal - x).norm(), 1e-14);
      surface.push_back(at.nearest);
    }
    for (int trial = 0; trial < 100; ++trial) {
      const Vector3 x = random_point(random, 1.5);
      const double far = std::abs(distance(sample.shape, x).gap);
      for (const Vector3& point : surface) ASSERT_GE((x - point).norm(), far - 1e-13);
    }
  }
}

TEST(ShapeDistance, NormalIsItsGradient) {
  Random random(44);
  constexpr double kStep = 1e-6;
  for (const Sample& sample : samples()) {
    int compared = 0;
    for (int trial = 0; trial < 200; ++trial) {
      const Vector3 x = random_point(random, 1.5);
      const ShapeDistance here = distance(sample.shape, x);
      Vector3 slope;
      bool smooth = true;
      for (int k = 0; k < 3; ++k) {
        const Vector3 step = kStep * Vector3::Unit(k);
        const ShapeDistance up = distance(sample.shape, x + step);
        const ShapeDistance down = distance(sample.shape, x - step);
        slope[k] = (up.gap - down.gap) / (2.0 * kStep);
        // The normal jumps across a medial plane.
        smooth = smooth && (up.normal - down.normal).norm() < 1e-3;
      }
      if (!smooth) continue;
      ++compared;
      EXPECT_LE((slope - here.normal).norm(), 1e-7) << sample.name;
    }
    EXPECT_GT(compared, 150);
  }
}

TEST(ShapeDistance, OfABoxIsThatOfItsTriangles) {
  Random random(45);
  const Matrix3 axes = random_rotation(random);
  const Vector3 half(0.5, 0.7, 0.3), centre(0.1, 0.2, 0.3);
  TestSurface surface = unit_box(1);
  for (Eigen::Index k = 0; k < surface.nodes.rows(); ++k) {
    const Vector3 local = 2.0 * surface.nodes.row(k).transpose() - Vector3::Ones();
    surface.nodes.row(k) = (centre + axes * half.cwiseProduct(local)).transpose();
  }
  ThreadPool pool;
  SurfaceTree tree(surface.topology());
  tree.move(surface.nodes, pool);
  for (int trial = 0; trial < 500; ++trial) {
    const Vector3 x = random_point(random, 1.2);
    const double far = nearest_on_surface(tree, x).distance;
    EXPECT_NEAR(distance(OrientedBox{centre, axes, half}, x).gap,
                winding_number(tree, x) == 1 ? -far : far, 1e-14);
  }
}

TEST(ShapeDistance, OnCentresAndAxes) {
  for (const Sample& sample : samples()) {
    const Vector3 centre = std::visit(
        [](const auto& own) -> Vector3 {
          if constexpr (requires { own.centre; }) return own.centre;
          if constexpr (requires { own.from; }) return 0.5 * (own.from + own.to);
          if constexpr (requires { own.point; }) return own.point;
          if constexpr (requires { own.origin; }) return own.origin;
        },
        sample.shape);
    const ShapeDistance at = distance(sample.shape, centre);
    EXPECT_NEAR(at.normal.norm(), 1.0, 1e-14) << sample.name;
    EXPECT_NEAR(distance(sample.shape, at.nearest).gap, 0.0, 1e-14) << sample.name;
  }
}

TEST(ShapeDistance, HasEveryRegionOfACapsule) {
  const Capsule capsule{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.25};
  EXPECT_DOUBLE_EQ(distance(capsule, {0.5, 1.0, 0.0}).gap, 0.75);   // beside the segment
  EXPECT_DOUBLE_EQ(distance(capsule, {-1.0, 0.0, 0.0}).gap, 0.75);  // before its start
  EXPECT_DOUBLE_EQ(distance(capsule, {1.0, 0.0, -2.0}).gap, 1.75);  // at its end
  EXPECT_DOUBLE_EQ(distance(capsule, {3.0, 0.0, 0.0}).gap, 1.75);   // beyond it
  const ShapeDistance inside = distance(capsule, {0.5, 0.0, 0.0});  // on the axis
  EXPECT_DOUBLE_EQ(inside.gap, -0.25);
  EXPECT_NEAR(inside.normal[0], 0.0, 1e-15);
  const Capsule ball{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.25};  // without length
  EXPECT_DOUBLE_EQ(distance(ball, {0.0, 1.0, 0.0}).gap, 0.75);
  EXPECT_DOUBLE_EQ(distance(Sphere{{0.0, 0.0, 0.0}, 0.25}, {0.0, 0.0, 0.0}).gap, -0.25);
}

TEST(Shape, RefusesSizesThatAreNone) {
  const auto refused = [](const Shape& shape) {
    return kind_of([&] { checked(shape); }) == ErrorKind::out_of_range;
  };
  EXPECT_TRUE(refused(Plane{{}, Vector3::Zero()}));
  EXPECT_TRUE(refused(Sphere{{}, 0.0}));
  EXPECT_TRUE(refused(Capsule{{}, {}, -1.0}));
  EXPECT_TRUE(refused(Cylinder{{1, 0, 0}, {1, 0, 0}, 1.0}));
  EXPECT_TRUE(refused(OrientedBox{{}, 2.0 * Matrix3::Identity(), {1, 1, 1}}));
  EXPECT_TRUE(refused(OrientedBox{{}, Matrix3::Identity(), {1, 0, 1}}));
  EXPECT_TRUE(refused(Sphere{{}, std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_EQ(checked(Plane{{}, {0, 0, 5}}).normal, Vector3::UnitZ());
}

}  // namespace
}  // namespace sinew::collision
