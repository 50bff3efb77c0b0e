#include "sinew/collision/triangle_intersection.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/collision/orientation.hpp"

#include "random_points.hpp"

namespace sinew::collision {
namespace {

using testing::random_grid_point;
using testing::random_point;

// Separating axes: two convex polygons are apart if and only if a face normal of their Minkowski
// difference separates them. The candidates are both normals, the cross products of the edges and,
// for coplanar triangles, the edge normals in the plane. For small integers the arithmetic is
// exact.
bool apart_by_axes(const Corners& a, const Corners& b) {
  const auto edges = [](const Corners& t) {
    return std::vector<Vector3>{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  };
  const auto e = edges(a), f = edges(b);
  const Vector3 n = e[0].cross(e[1]), m = f[0].cross(f[1]);
  std::vector<Vector3> axes{n, m};
  for (const Vector3& x : e) {
    axes.push_back(n.cross(x));
    for (const Vector3& y : f) axes.push_back(x.cross(y));
  }
  for (const Vector3& y : f) axes.push_back(m.cross(y));
  return std::ranges::any_of(axes, [&](const Vector3& axis) {
    double a_low = kInfinity, a_high = -kInfinity, b_low = kInfinity, b_high = -kInfinity;
    for (std::size_t k = 0; k < 3; ++k) {
      a_low = std::min(a_low, axis.dot(a[k]));
      a_high = std::max(a_high, axis.dot(a[k]));
      b_low = std::min(b_low, axis.dot(b[k]));
      b_high = std::max(b_high, axis.dot(b[k]));
    }
    return a_high < b_low || b_high < a_low;
  });
}

bool is_flat(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).isZero(0.0); }

TEST(TrianglesMeet, AgreesWithSeparatingAxesOnAGrid) {
  for (const int most : {1, 2, 3, 6}) {
    Random random(static_cast<std::uint64_t>(most));
    int met = 0, apart = 0;
    for (int trial = 0; trial < 20000; ++trial) {
      Corners a, b;
      for (Vector3& x : a) x = random_grid_point(random, most);
      for (Vector3& x : b) x = random_grid_point(random, most);
      if (is_flat(a) || is_flat(b)) continue;
      const bool expected = !apart_by_axes(a, b);
      ASSERT_EQ(triangles_meet(a, b), expected);
      ASSERT_EQ(triangles_meet(b, a), expected);
      (expected ? met : apart)++;
    }
    EXPECT_GT(met, 1000);
    EXPECT_GT(apart, 500);
  }
}

TEST(TrianglesMeet, TakesFlatOnes) {
  const Corners face{Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(0, 4, 0)};
  const auto segment = [](const Vector3& a, const Vector3& b) {
    return Corners{a, b, 0.5 * (a + b)};
  };
  EXPECT_TRUE(triangles_meet(face, segment({1, 1, -1}, {1, 1, 1})));
  EXPECT_TRUE(triangles_meet(face, segment({1, 1, 0}, {1, 1, 1})));
  EXPECT_FALSE(triangles_meet(face, segment({1, 1, 1}, {1, 1, 2})));
  EXPECT_FALSE(triangles_meet(face, segment({3, 3, -1}, {3, 3, 1})));
  EXPECT_TRUE(triangles_meet(face, segment({1, 1, 0}, {2, 1, 0})));
  EXPECT_TRUE(triangles_meet(face, segment({2, 2, -1}, {2, 2, 1})));
  EXPECT_TRUE(triangles_meet(segment({0, 0, 0}, {2, 2, 2}), segment({2, 0, 0}, {0, 2, 2})));
  EXPECT_FALSE(triangles_meet(segment({0, 0, 0}, {2, 2, 2}), segment({4, 4, 4}, {8, 8, 8})));
  EXPECT_TRUE(triangles_meet(segment({0, 0, 0}, {2, 2, 2}), segment({2, 2, 2}, {8, 8, 8})));
  const Corners point{Vector3(1, 1, 0), Vector3(1, 1, 0), Vector3(1, 1, 0)};
  EXPECT_TRUE(triangles_meet(face, point));
  EXPECT_TRUE(triangles_meet(point, point));
  EXPECT_FALSE(triangles_meet(point, segment({0, 0, 0}, {8, 4, 0})));
  EXPECT_TRUE(triangles_meet(point, segment({0, 0, 0}, {4, 4, 0})));
}

TEST(Orientation, IsExactNextToAPlane) {
  // d = a + s (b - a) + t (c - a) is exact for numbers of few bits; one ulp beside it the sign
  // changes.
  Random random(7);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector3 a = random_grid_point(random, 1 << 20) * 0x1p-20;
    const Vector3 b = a + random_grid_point(random, 1 << 12),
                  c = a + random_grid_point(random, 1 << 12);
    const Vector3 d = a + 0.25 * (b - a) + 0.5 * (c - a);
    EXPECT_EQ(orientation(a, b, c, d), 0);
    const Vector3 normal = (b - a).cross(c - a);
    if (normal[2] == 0.0) continue;
    Vector3 above = d;
    above[2] = std::nextafter(d[2], kInfinity);
    EXPECT_EQ(orientation(a, b, c, above), normal[2] > 0.0 ? 1 : -1);
    EXPECT_EQ(orientation(b, a, c, above), normal[2] > 0.0 ? -1 : 1);
    EXPECT_EQ(orientation_along(2, a, b, c), normal[2] > 0.0 ? 1 : -1);
  }
}

TEST(SegmentMeetsTriangle, AtItsCornerByExactArithmetic) {
  // Through a corner, and past it by one unit in the last place.
  Random random(8);
  for (int trial = 0; trial < 500; ++trial) {
    const Vector3 corner = random_grid_point(random, 1 << 20) * 0x1p-20;
    const Corners face{corner, corner + Vector3(1, 0, 0), corner + Vector3(0, 1, 0)};
    const Vector3 way(0.25, -0.5, 2.0);
    EXPECT_TRUE(segment_meets_triangle(corner - way, corner + way, face));
    Vector3 shift = Vector3::Zero();
    shift[0] = -0x1p-40;
    EXPECT_FALSE(segment_meets_triangle(corner - way + shift, corner + way + shift, face));
  }
}

}  // namespace
}  // namespace sinew::collision
