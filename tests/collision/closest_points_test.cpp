#include "sinew/collision/closest_points.hpp"

#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "random_points.hpp"

namespace sinew::collision {
namespace {

using testing::random_point;

// Minimum of a convex function on [0, 1] by golden-section search.
double least(const std::function<double(double)>& value) {
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = 0.0, high = 1.0;
  while (high - low > 1e-9) {
    const double a = high - ratio * (high - low), b = low + ratio * (high - low);
    (value(a) < value(b) ? high : low) = value(a) < value(b) ? b : a;
  }
  return std::min({value(low), value(0.5 * (low + high)), value(high), value(0.0), value(1.0)});
}

// The triangle is parametrised as b + s (c - b) + t (a - b - s (c - b)). The squared distance is
// convex in t. Its minimum over t is convex in s if the domain is written as a convex one.
double distance_by_search(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  return std::sqrt(least([&](double t) {
    return least([&](double s) {
      return (p - (t * a + (1.0 - t) * (s * c + (1.0 - s) * b))).squaredNorm();
    });
  }));
}

double distance_by_search(const Vector3& a0, const Vector3& a1, const Vector3& b0,
                          const Vector3& b1, bool) {
  return std::sqrt(least([&](double s) {
    return least([&](double t) { return (a0 + s * (a1 - a0) - b0 - t * (b1 - b0)).squaredNorm(); });
  }));
}

// Golden-section search finds the minimum of the squared distance to the square of its step, so a
// distance near zero is accurate to the step only.
constexpr double kSearch = 3e-8;

void expect_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  const OnTriangle on = closest_on_triangle(p, a, b, c);
  EXPECT_GE(on.weights.minCoeff(), 0.0);
  EXPECT_NEAR(on.weights.sum(), 1.0, 1e-15);
  const Vector3 point = on.weights[0] * a + on.weights[1] * b + on.weights[2] * c;
  EXPECT_LE((point - on.point).norm(), 1e-14);
  EXPECT_NEAR((p - on.point).norm(), distance_by_search(p, a, b, c), kSearch);
}

void expect_edges(const Vector3& a0, const Vector3& a1, const Vector3& b0, const Vector3& b1) {
  const OnEdges on = closest_on_edges(a0, a1, b0, b1);
  EXPECT_GE(std::min(on.first, on.second), 0.0);
  EXPECT_LE(std::max(on.first, on.second), 1.0);
  EXPECT_LE((a0 + on.first * (a1 - a0) - on.first_point).norm(), 1e-14);
  EXPECT_LE((b0 + on.second * (b1 - b0) - on.second_point).norm(), 1e-14);
  EXPECT_NEAR((on.first_point - on.second_point).norm(), distance_by_search(a0, a1, b0, b1, true),
              kSearch);
}

TEST(ClosestOnTriangle, IsTheLeastDistance) {
  Random random(1);
  for (int trial = 0; trial < 150; ++trial) {
    expect_triangle(random_point(random, 2.0), random_point(random), random_point(random),
                    random_point(random));
  }
}

TEST(ClosestOnTriangle, HasEveryRegion) {
  const Vector3 a(0, 0, 0), b(2, 0, 0), c(0, 2, 0);
  const auto weights = [&](double x, double y) {
    return closest_on_triangle({x, y, 1.0}, a, b, c).weights;
  };
  EXPECT_EQ(weights(0.5, 0.5), Vector3(0.5, 0.25, 0.25));
  EXPECT_EQ(weights(1.0, -1.0), Vector3(0.5, 0.5, 0.0));
  EXPECT_EQ(weights(3.0, 3.0), Vector3(0.0, 0.5, 0.5));
  EXPECT_EQ(weights(-1.0, 1.0), Vector3(0.5, 0.0, 0.5));
  EXPECT_EQ(weights(-1.0, -1.0), Vector3(1.0, 0.0, 0.0));
  EXPECT_EQ(weights(3.0, -2.0), Vector3(0.0, 1.0, 0.0));
  EXPECT_EQ(weights(-2.0, 3.0), Vector3(0.0, 0.0, 1.0));
}

TEST(ClosestOnTriangle, TakesFlatOnes) {
  Random random(2);
  for (int trial = 0; trial < 40; ++trial) {
    const Vector3 p = random_point(random), a = random_point(random), b = random_point(random);
    expect_triangle(p, a, b, a + random.uniform(-1.0, 2.0) * (b - a));  // collinear corners
    expect_triangle(p, a, b, b);
    expect_triangle(p, a, a, a);
    expect_triangle(p, a, b, a + 0.5 * (b - a) + 1e-9 * random_point(random));
  }
  const Vector3 a(0, 0, 0), b(1, 0, 0), c(3, 0, 0);
  EXPECT_EQ(closest_on_triangle({2, 1, 0}, a, b, c).point, Vector3(2, 0, 0));
  EXPECT_EQ(closest_on_triangle({2, 1, 0}, a, a, a).point, a);
}

TEST(ClosestOnTriangle, IsObtuse) {
  // The projection lies outside the edge a b, but the nearest point is on b c.
  const Vector3 a(0, 0, 0), b(1, 0, 0), c(3, 0.2, 0);
  expect_triangle({2.0, -0.5, 0.0}, a, b, c);
  EXPECT_EQ(closest_on_triangle({2.0, -0.5, 0.0}, a, b, c).weights[0], 0.0);
}

TEST(ClosestOnEdges, IsTheLeastDistance) {
  Random random(3);
  for (int trial = 0; trial < 150; ++trial) {
    expect_edges(random_point(random), random_point(random), random_point(random),
                 random_point(random));
  }
}

TEST(ClosestOnEdges, TakesParallelOnes) {
  Random random(4);
  for (int trial = 0; trial < 60; ++trial) {
    const Vector3 a = random_point(random), along = random_point(random), b = random_point(random);
    for (const double turned : {0.0, 1e-16, 1e-12, 1e-8, 1e-5}) {
      const Vector3 other = random.uniform(-2.0, 2.0) * along + turned * random_point(random);
      expect_edges(a, a + along, b, b + other);
    }
    expect_edges(a, a + along, a + 0.5 * along, a + 1.5 * along);  // collinear edges
    expect_edges(a, a + along, a + 2.0 * along, a + 3.0 * along);
  }
}

TEST(ClosestOnEdges, TakesThoseOfNoLength) {
  Random random(5);
  for (int trial = 0; trial < 40; ++trial) {
    const Vector3 a = random_point(random), b = random_point(random), c = random_point(random);
    expect_edges(a, a, b, c);
    expect_edges(a, b, c, c);
    expect_edges(a, a, c, c);
  }
}

TEST(ClosestOnEdges, CrossingOnesMeet) {
  const OnEdges on = closest_on_edges({-1, 0, 0}, {1, 0, 0}, {0.5, -1, 0}, {0.5, 3, 0});
  EXPECT_EQ(on.first, 0.75);
  EXPECT_EQ(on.second, 0.25);
  EXPECT_EQ(on.first_point, on.second_point);
}

}  // namespace
}  // namespace sinew::collision
