#include "sinew/collision/penetration.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/collision/overlap_volume.hpp"

#include "support/error_kind.hpp"
#include "surfaces.hpp"

namespace sinew::collision {
namespace {

using namespace testing;
using sinew::testing::kind_of;

TEST(Penetration, VerticesInsideABall) {
  const TestSurface box = unit_box(6), ball = unit_sphere(10);
  ThreadPool pool(2);
  Penetration penetration(pool);
  SurfaceTree a(box.topology()), b(ball.topology());
  a.move(placed(box.nodes, Matrix3::Identity(), {0.31, -0.45, -0.35}), pool);
  b.move(ball.nodes, pool);
  const auto inside = penetration.inside(a, b);
  std::vector<char> found(static_cast<std::size_t>(box.nodes.rows()), 0);
  for (const InsideVertex& x : inside) {
    found[static_cast<std::size_t>(x.node)] = 1;
    const Vector3 at = a.at(x.node);
    EXPECT_LE((at + x.depth * x.normal - x.nearest.point).norm(), 1e-14);
    EXPECT_NEAR(x.depth, 1.0 - at.norm(), 0.02);  // flat triangles deviate from the sphere
    EXPECT_GT(x.normal.dot(at), 0.0);
  }
  int deep = 0;
  for (NodeId k = 0; k < box.nodes.rows(); ++k) {
    const double far = a.at(k).norm();
    EXPECT_TRUE(far > 0.99 || found[static_cast<std::size_t>(k)]);
    EXPECT_TRUE(far < 1.0 || !found[static_cast<std::size_t>(k)]);
    deep += far < 0.99 ? 1 : 0;
  }
  EXPECT_GT(deep, 20);
}

TEST(Penetration, CrossingTrianglesAreThoseOfAllPairs) {
  Random random(61);
  const TestSurface ring = torus(1.0, 0.4, 12, 6);
  ThreadPool pool(2);
  Penetration penetration(pool);
  SurfaceTree a(ring.topology()), b(ring.topology());
  a.move(shaken(ring.nodes, random, 0.1), pool);
  b.move(placed(ring.nodes, random_rotation(random), {1.0, 0.1, 0.2}), pool);
  const auto count = [&](const SurfaceTree& x, const SurfaceTree& y) {
    std::size_t met = 0;
    for (int i = 0; i < 144; ++i) {
      for (int j = 0; j < 144; ++j) met += triangles_meet(x.corners(i), y.corners(j)) ? 1 : 0;
    }
    return met;
  };
  EXPECT_EQ(penetration.crossing(a, b).size(), count(a, b));
  EXPECT_GT(count(a, b), 10u);
  EXPECT_EQ(penetration.crossing_within(b).size(), 0u);
  a.move(shaken(ring.nodes, random, 0.6), pool);
  EXPECT_GT(penetration.crossing_within(a).size(), 0u);
}

TEST(Penetration, WantsClosedSurfaces) {
  const TestSurface box = unit_box(1), square = unit_square(1);
  ThreadPool pool;
  Penetration penetration(pool);
  SurfaceTree a(box.topology()), b(square.topology());
  a.move(box.nodes, pool);
  b.move(square.nodes, pool);
  EXPECT_EQ(kind_of([&] { penetration.inside(a, b); }), ErrorKind::surface_not_closed);
  EXPECT_EQ(kind_of([&] { OverlapVolume(box.topology(), square.topology(), pool); }),
            ErrorKind::surface_not_closed);
}

class Overlap {
 public:
  Overlap(const TestSurface& a, const TestSurface& b)
      : volume_(a.topology(), b.topology(), pool_) {}
  double operator()(const Points& a, const Points& b) {
    volume_.compute(a, b);
    return volume_.volume();
  }
  const OverlapVolume& last() const { return volume_; }

 private:
  ThreadPool pool_{2};
  OverlapVolume volume_;
};

TEST(OverlapVolume, OfBoxesIsTheProductOfTheirOverlaps) {
  const Matrix3 upright = Matrix3::Identity();
  for (const int cells : {1, 2, 3}) {
    const TestSurface a = unit_box(2), b = unit_box(cells);
    Overlap overlap(a, b);
    // In many of these placements, faces, edges and diagonals of both coincide.
    for (const double x : {-1.5, -1.0, -0.75, -0.5, 0.0, 0.3, 1.0}) {
      for (const double y : {-0.5, 0.0, 0.125}) {
        for (const double z : {-0.25, 0.0, 0.5}) {
          const double expected = std::max(0.0, 1 - std::abs(x)) * std::max(0.0, 1 - std::abs(y)) *
                                  std::max(0.0, 1 - std::abs(z));
          EXPECT_NEAR(overlap(a.nodes, placed(b.nodes, upright, {x, y, z})), expected, 2e-11)
              << x << ' ' << y << ' ' << z;
        }
      }
    }
    // One inside the other, then far apart.
    EXPECT_NEAR(overlap(a.nodes, placed(b.nodes, upright, {.2, .3, .4}, 0.25)), 1 / 64.0, 1e-14);
    EXPECT_NEAR(overlap(placed(a.nodes, upright, {.2, .3, .4}, 0.25), b.nodes), 1 / 64.0, 1e-14);
    EXPECT_EQ(overlap(a.nodes, placed(b.nodes, upright, {5, 5, 5})), 0.0);
  }
}

TEST(OverlapVolume, DoesNotChangeWithAMotionOfBoth) {
  Random random(62);
  const TestSurface a = torus(1.0, 0.4, 16, 8), b = unit_box(3);
  Overlap overlap(a, b);
  const Points moved = placed(b.nodes, random_rotation(random), {0.4, 0.1, -0.3});
  const double expected = overlap(a.nodes, moved);
  EXPECT_GT(expected, 0.05);
  for (int trial = 0; trial < 10; ++trial) {
    const Matrix3 turn = random_rotation(random);
    const Vector3 shift = random_point(random, 10.0);
    EXPECT_NEAR(overlap(placed(a.nodes, turn, shift), placed(moved, turn, shift)), expected, 1e-11);
  }
}

TEST(OverlapVolume, IsThatOfSampledPoints) {
  Random random(63);
  ThreadPool pool;
  const TestSurface a = torus(1.0, 0.4, 16, 8), b = torus(0.9, 0.35, 14, 7);
  Overlap overlap(a, b);
  for (int trial = 0; trial < 3; ++trial) {
    const Points x = shaken(a.nodes, random, 0.05);
    const Points y = placed(b.nodes, random_rotation(random), random_point(random, 0.6));
    SurfaceTree first(a.topology()), second(b.topology());
    first.move(x, pool);
    second.move(y, pool);
    // Low-discrepancy points in the bounding box of the first surface (Kronecker lattice of three
    // irrational steps).
    const Box& box = first.branches().front().box;
    constexpr int kCount = 200000;
    int inside = 0;
    for (int k = 1; k <= kCount; ++k) {
      const Vector3 share(std::fmod(k * 0.8191725133961645, 1.0),
                          std::fmod(k * 0.6710436067037893, 1.0),
                          std::fmod(k * 0.5497004779019703, 1.0));
      const Vector3 point = box.low + share.cwiseProduct(box.high - box.low);
      inside += winding_number(first, point) * winding_number(second, point);
    }
    const double whole = (box.high - box.low).prod();
    EXPECT_NEAR(overlap(x, y), whole * inside / kCount, 2e-3 * whole);
  }
}

TEST(OverlapVolume, GradientIsItsDerivative) {
  Random random(64);
  const TestSurface a = torus(1.0, 0.4, 12, 6), b = unit_sphere(3);
  Overlap overlap(a, b);
  const Points x = shaken(a.nodes, random, 0.05);
  const Points y = placed(b.nodes, random_rotation(random), {0.9, 0.2, 0.3}, 0.6);
  EXPECT_GT(overlap(x, y), 0.1);
  const Points by_x = overlap.last().first_gradient(), by_y = overlap.last().second_gradient();
  EXPECT_GT(by_x.norm(), 0.1);
  // The gradients balance: a common translation changes nothing.
  EXPECT_LE((by_x.colwise().sum() + by_y.colwise().sum()).norm(), 1e-12);
  constexpr double kStep = 1e-6;
  for (int trial = 0; trial < 30; ++trial) {
    const Points dx = shaken(0.0 * x, random, 1.0), dy = shaken(0.0 * y, random, 1.0);
    const double slope =
        (overlap(x + kStep * dx, y + kStep * dy) - overlap(x - kStep * dx, y - kStep * dy)) /
        (2.0 * kStep);
    const double expected = by_x.cwiseProduct(dx).sum() + by_y.cwiseProduct(dy).sum();
    EXPECT_NEAR(slope, expected, 1e-7 * (by_x.norm() + by_y.norm()));
  }
}

TEST(OverlapVolume, DoesNotDependOnThreads) {
  Random random(65);
  const TestSurface a = torus(1.0, 0.4, 30, 15), b = unit_sphere(10);
  const Points y = placed(b.nodes, random_rotation(random), {0.9, 0.2, 0.3}, 0.6);
  double expected = 0.0;
  Points gradient;
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    OverlapVolume overlap(a.topology(), b.topology(), pool);
    overlap.compute(a.nodes, y);
    if (threads == 1) {
      expected = overlap.volume();
      gradient = overlap.first_gradient();
    }
    EXPECT_EQ(overlap.volume(), expected);
    EXPECT_EQ(overlap.first_gradient(), gradient);
  }
}

}  // namespace
}  // namespace sinew::collision
