#include "sinew/collision/impact.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/collision/closest_points.hpp"

#include "random_points.hpp"

namespace sinew::collision {
namespace {

using testing::random_grid_point;
using testing::random_integer;
using testing::random_point;

enum class Kind { vertex_face, edge_edge };

std::optional<double> impact(Kind kind, const FourPoints& start, const FourPoints& end,
                             double separation = 0.0) {
  return kind == Kind::vertex_face ? vertex_face_impact(start, end, separation)
                                   : edge_edge_impact(start, end, separation);
}

double distance(Kind kind, const FourPoints& x) {
  if (kind == Kind::vertex_face) {
    return (closest_on_triangle(x[0], x[1], x[2], x[3]).point - x[0]).norm();
  }
  const OnEdges on = closest_on_edges(x[0], x[1], x[2], x[3]);
  return (on.first_point - on.second_point).norm();
}

FourPoints between(const FourPoints& start, const FourPoints& end, double time) {
  FourPoints x;
  for (std::size_t i = 0; i < 4; ++i) x[i] = start[i] + time * (end[i] - start[i]);
  return x;
}

// Minimum distance over a fine grid of times, refined near the minimum.
double least_distance(Kind kind, const FourPoints& start, const FourPoints& end) {
  double least = kInfinity, best = 0.0;
  for (double step = 1.0 / 64.0, from = 0.0, to = 1.0; step > 1e-9; step /= 16.0) {
    for (double time = from; time <= to; time += step) {
      const double here = distance(kind, between(start, end, time));
      if (here < least) {
        least = here;
        best = time;
      }
    }
    from = std::max(0.0, best - step);
    to = std::min(1.0, best + step);
  }
  return least;
}

struct Touch {
  FourPoints start, end;
  double time;
};

// Four points that touch at a known time, all numbers exact: integer positions x* at the time k/16,
// weights that are multiples of 1/16, and start = x* - k v, end = x* + (16 - k) v with integer v.
Touch exact_touch(Kind kind, Random& random, int most, int fast) {
  FourPoints x;
  for (Vector3& point : x) point = 256.0 * random_grid_point(random, most);
  const double s = random_integer(random, 16) / 16.0, t = random_integer(random, 16) / 16.0;
  if (kind == Kind::vertex_face) {
    x[0] = t * x[1] + (1.0 - t) * (s * x[2] + (1.0 - s) * x[3]);
  } else {
    // Shifts the second edge so that its point at t coincides with the point at s of the first one.
    const Vector3 gap = x[0] + s * (x[1] - x[0]) - (x[2] + t * (x[3] - x[2]));
    x[2] += gap;
    x[3] += gap;
  }
  const int k = random_integer(random, 16);
  Touch touch{x, x, k / 16.0};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3 v = random_grid_point(random, 2 * fast) - Vector3::Constant(fast);
    touch.start[i] -= k * v;
    touch.end[i] += (16 - k) * v;
  }
  return touch;
}

class Impact : public ::testing::TestWithParam<Kind> {};

TEST_P(Impact, MissesNoTouch) {
  Random random(11);
  for (int trial = 0; trial < 40000; ++trial) {
    // Small integers often give degenerate motions: coplanar, collinear or no motion at all.
    const int most = 1 << (trial % 12), fast = trial % 5 == 0 ? 0 : 1 << (trial % 11);
    const Touch touch = exact_touch(GetParam(), random, most, fast);
    const auto time = impact(GetParam(), touch.start, touch.end);
    ASSERT_TRUE(time.has_value()) << trial;
    ASSERT_LE(*time, touch.time) << trial;
    ASSERT_GE(*time, 0.0);
  }
}

TEST_P(Impact, MissesNoTouchWhateverTheScaleAndPlace) {
  Random random(12);
  for (int trial = 0; trial < 4000; ++trial) {
    Touch touch = exact_touch(GetParam(), random, 64, 32);
    const double scale = std::ldexp(1.0, random_integer(random, 80) - 40);
    // 2^22 times larger: still exact, but with strong cancellation.
    const Vector3 place = random_grid_point(random, 2) * 0x1p40;
    for (Vector3& x : touch.start) x = scale * (x + place);
    for (Vector3& x : touch.end) x = scale * (x + place);
    const auto time = impact(GetParam(), touch.start, touch.end);
    ASSERT_TRUE(time.has_value());
    ASSERT_LE(*time, touch.time);
  }
}

TEST_P(Impact, FindsNoneWhereTheDistanceStaysLarge) {
  Random random(13);
  int misses = 0, false_ones = 0, near = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    FourPoints start, end;
    for (Vector3& x : start) x = random_point(random);
    for (Vector3& x : end) x = random_point(random);
    const double least = least_distance(GetParam(), start, end);
    // The time grid of 1/64 may miss a minimum as shallow as this.
    if (least < 1e-6) continue;
    ++misses;
    if (least < 0.05) ++near;
    if (impact(GetParam(), start, end).has_value()) ++false_ones;
  }
  EXPECT_GT(misses, 1000);
  EXPECT_GT(near, 50);
  // The time grid misses a few narrow contacts, which count as false here.
  EXPECT_LE(false_ones, misses / 500);
}

TEST_P(Impact, TimeIsThatOfTheFirstTouch) {
  Random random(14);
  int hits = 0;
  for (int trial = 0; trial < 6000; ++trial) {
    FourPoints start, end;
    for (Vector3& x : start) x = random_point(random);
    for (Vector3& x : end) x = random_point(random);
    const auto time = impact(GetParam(), start, end);
    if (!time) continue;
    ++hits;
    EXPECT_LE(distance(GetParam(), between(start, end, *time)), 1e-10);
    for (int k = 0; k < 100; ++k) {
      EXPECT_GT(distance(GetParam(), between(start, end, *time * k / 100.0 * 0.999)), 0.0);
    }
  }
  EXPECT_GT(hits, 300);
}

TEST_P(Impact, SeparationIsADistance) {
  Random random(15);
  int sure = 0, spared = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    FourPoints start, end;
    for (Vector3& x : start) x = random_point(random);
    for (Vector3& x : end) x = random_point(random);
    const double least = least_distance(GetParam(), start, end);
    if (distance(GetParam(), start) < 0.1) continue;
    const auto time = impact(GetParam(), start, end, 0.1);
    if (least < 0.1) {
      ++sure;
      ASSERT_TRUE(time.has_value());
      // The time is a lower bound: at all earlier times the distance is kept.
      for (int k = 0; k < 50; ++k) {
        EXPECT_GE(distance(GetParam(), between(start, end, *time * k / 50.0)), 0.1 * (1 - 1e-12));
      }
      EXPECT_LE(distance(GetParam(), between(start, end, *time)), 0.1 * (1 + 1e-3));
    } else if (least > 0.1 * (1 + 1e-3)) {
      spared += !time.has_value();
      EXPECT_FALSE(time.has_value());
    }
  }
  EXPECT_GT(sure, 300);
  EXPECT_GT(spared, 300);
}

TEST_P(Impact, RestsApartOrTouching) {
  const bool face = GetParam() == Kind::vertex_face;
  const FourPoints x =
      face
          ? FourPoints{Vector3(0.25, 0.25, 0), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)}
          : FourPoints{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0.5, -1, 0), Vector3(0.5, 1, 0)};
  EXPECT_EQ(impact(GetParam(), x, x), 0.0);
  FourPoints above = x;
  above[0][2] += 1e-12;
  if (!face) above[1][2] += 1e-12;
  EXPECT_EQ(impact(GetParam(), above, above), std::nullopt);
  EXPECT_EQ(impact(GetParam(), above, above, 2e-12), 0.0);
  EXPECT_TRUE(impact(GetParam(), above, x).has_value());  // at the very end
}

TEST_P(Impact, CountsNumbersThatAreNotFinite) {
  Random random(16);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        FourPoints start, end;
        for (Vector3& x : start) x = random_point(random);
        start[0][(k + 1) % 3] += 10.0;  // far apart otherwise
        end = start;
        (random.bits() % 2 == 0 ? start : end)[i][k] = bad;
        EXPECT_EQ(impact(GetParam(), start, end), 0.0);
      }
    }
  }
}

TEST(VertexFaceImpact, PassesBesideAnEdge) {
  // The point crosses the plane at this distance outside the edge x = 0.
  for (const double beside : {1e-3, 1e-9, 1e-13}) {
    const FourPoints start{Vector3(-beside, 0.3, 1), Vector3(0, 0, 0), Vector3(1, 0, 0),
                           Vector3(0, 1, 0)};
    FourPoints end = start;
    end[0][2] = -2.0;
    EXPECT_EQ(vertex_face_impact(start, end), std::nullopt) << beside;
    FourPoints inside = start, inside_end = end;
    inside[0][0] = inside_end[0][0] = beside;
    const auto time = vertex_face_impact(inside, inside_end);
    ASSERT_TRUE(time.has_value());
    EXPECT_NEAR(*time, 1.0 / 3.0, 1e-14);
  }
}

TEST(EdgeEdgeImpact, OfParallelEdges) {
  const FourPoints start{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0.5, 0, 1),
                         Vector3(1.5, 0, 1)};
  FourPoints end = start;
  end[2][2] = end[3][2] = -1.0;
  const auto time = edge_edge_impact(start, end);
  ASSERT_TRUE(time.has_value());
  EXPECT_NEAR(*time, 0.5, 1e-14);
  FourPoints beside = start, beside_end = end;
  beside[2][0] = beside_end[2][0] = 1.0 + 1e-12;  // collinear, without overlap
  EXPECT_EQ(edge_edge_impact(beside, beside_end), std::nullopt);
}

TEST(VertexFaceImpact, OfAFlatTriangle) {
  const FourPoints start{Vector3(0.5, 1, 0), Vector3(0, 0, 0), Vector3(1, 0, 0),
                         Vector3(0.3, 0, 0)};
  FourPoints end = start;
  end[0][1] = -1.0;
  const auto time = vertex_face_impact(start, end);
  ASSERT_TRUE(time.has_value());
  EXPECT_NEAR(*time, 0.5, 1e-12);
  FourPoints beside = start, beside_end = end;
  beside[0][2] = beside_end[0][2] = 1e-9;
  EXPECT_EQ(vertex_face_impact(beside, beside_end), std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Impact, ::testing::Values(Kind::vertex_face, Kind::edge_edge),
                         [](const auto& kind) {
                           return kind.param == Kind::vertex_face ? "VertexFace" : "EdgeEdge";
                         });

}  // namespace
}  // namespace sinew::collision
