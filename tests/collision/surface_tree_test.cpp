#include "sinew/collision/surface_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/collision/closest_points.hpp"
#include "sinew/collision/point_query.hpp"
#include "sinew/collision/triangle_pairs.hpp"

#include "support/error_kind.hpp"
#include "surfaces.hpp"

namespace sinew::collision {
namespace {

using namespace testing;
using sinew::testing::kind_of;

TEST(SurfaceTopology, CountsAndOwnsEverythingOnce) {
  const TestSurface sphere = unit_sphere(5);
  const auto topology = sphere.topology();
  const auto nodes = static_cast<int>(sphere.nodes.rows());
  const auto triangles = static_cast<int>(sphere.triangles.size());
  const auto edges = static_cast<int>(topology->edges().size());
  EXPECT_EQ(nodes - edges + triangles, 2);  // Euler's formula
  EXPECT_TRUE(topology->closed());
  std::multiset<int> own_nodes, own_edges;
  for (int t = 0; t < triangles; ++t) {
    for (const int node : topology->own_nodes(t)) {
      own_nodes.insert(node);
      EXPECT_EQ(std::ranges::count(topology->triangles()[static_cast<std::size_t>(t)], node), 1);
    }
    for (const int edge : topology->own_edges(t)) {
      own_edges.insert(edge);
      EXPECT_EQ(std::ranges::count(topology->edges_of(t), edge), 1);
    }
  }
  for (int k = 0; k < nodes; ++k) EXPECT_EQ(own_nodes.count(k), 1u);
  for (int k = 0; k < edges; ++k) EXPECT_EQ(own_edges.count(k), 1u);
}

TEST(SurfaceTopology, OpenSurfacesAndTurnedTrianglesAreNotClosed) {
  EXPECT_FALSE(unit_square(2).topology()->closed());
  TestSurface box = unit_box();
  std::swap(box.triangles[0][0], box.triangles[0][1]);
  EXPECT_FALSE(box.topology()->closed());
}

TEST(SurfaceTopology, RefusesBrokenInput) {
  EXPECT_EQ(kind_of([] { SurfaceTopology({}, 3); }), ErrorKind::empty_region);
  EXPECT_EQ(kind_of([] { SurfaceTopology({{0, 1, 3}}, 3); }), ErrorKind::index_out_of_range);
  EXPECT_EQ(kind_of([] { SurfaceTopology({{0, 1, 1}}, 3); }), ErrorKind::repeated_node_in_element);
  ThreadPool pool;
  const TestSurface box = unit_box();
  SurfaceTree tree(box.topology());
  EXPECT_EQ(kind_of([&] { tree.move(Points::Zero(3, 3), pool); }), ErrorKind::wrong_shape);
  Points broken = box.nodes;
  broken(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(kind_of([&] { tree.move(broken, pool); }), ErrorKind::not_finite);
}

std::vector<std::pair<int, int>> sorted(std::span<const TrianglePair> pairs, bool unordered) {
  std::vector<std::pair<int, int>> result;
  for (const TrianglePair& pair : pairs) {
    result.emplace_back(unordered ? std::min(pair.first, pair.second) : pair.first,
                        unordered ? std::max(pair.first, pair.second) : pair.second);
  }
  std::ranges::sort(result);
  return result;
}

std::vector<std::pair<int, int>> all_pairs(const SurfaceTree& a, const SurfaceTree& b,
                                           double distance, bool same) {
  std::vector<std::pair<int, int>> result;
  const auto count = [](const SurfaceTree& x) {
    return static_cast<int>(x.topology().triangles().size());
  };
  for (int i = 0; i < count(a); ++i) {
    for (int j = same ? i + 1 : 0; j < count(b); ++j) {
      const Vector3 gap = (a.box(i).low - b.box(j).high).cwiseMax(b.box(j).low - a.box(i).high);
      if (gap.maxCoeff() <= distance) result.emplace_back(i, j);
    }
  }
  return result;
}

TEST(TrianglePairs, AreThoseOfAllPairs) {
  Random random(21);
  ThreadPool pool(2);
  TrianglePairs finder(pool);
  const TestSurface sphere = unit_sphere(6), ring = torus(1.0, 0.4, 18, 9);
  SurfaceTree a(sphere.topology()), b(ring.topology());
  for (int trial = 0; trial < 12; ++trial) {
    const double distance = trial % 3 == 0 ? 0.0 : random.uniform(0.0, 0.3);
    const Points start = placed(sphere.nodes, random_rotation(random), random_point(random, 1.5));
    a.move(start, pool);
    if (trial % 2 == 0) {
      b.move(shaken(ring.nodes, random, 0.1), pool);
    } else {
      b.sweep(ring.nodes, shaken(ring.nodes, random, 0.3), pool);
    }
    EXPECT_EQ(sorted(finder.between(a, b, distance), false), all_pairs(a, b, distance, false));
    EXPECT_EQ(sorted(finder.within(b, distance), true), all_pairs(b, b, distance, true));
  }
}

TEST(TrianglePairs, ReachAsFarAsTheirTrianglesMove) {
  Random random(23);
  ThreadPool pool(2);
  TrianglePairs finder(pool);
  const TestSurface sphere = unit_sphere(6), ring = torus(1.0, 0.4, 18, 9);
  SurfaceTree a(sphere.topology()), b(ring.topology());
  const auto motions = [&](const TestSurface& surface) -> VectorX {
    VectorX motion(surface.nodes.rows());
    for (double& one : motion) one = std::pow(random.uniform(0.0, 0.8), 4);
    return motion;
  };
  const auto of = [](const TestSurface& surface, int triangle, const VectorX& motion) {
    double most = 0.0;
    for (const NodeId node : surface.triangles[static_cast<std::size_t>(triangle)]) {
      most = std::max(most, motion[node]);
    }
    return most;
  };
  constexpr double kDistance = 0.1, kAll = 1.0;
  for (int trial = 0; trial < 8; ++trial) {
    a.move(placed(sphere.nodes, random_rotation(random), random_point(random, 1.5)), pool);
    b.move(shaken(ring.nodes, random, 0.1), pool);
    const auto near = all_pairs(a, b, kDistance, false);
    const VectorX first = motions(sphere), second = motions(ring);
    std::vector<std::pair<int, int>> expected;
    for (const auto& [i, j] : all_pairs(a, b, kAll, false)) {
      const double far = std::max(kDistance, of(sphere, i, first) + of(ring, j, second));
      if (!a.box(i).is_apart(b.box(j), far)) expected.emplace_back(i, j);
    }
    EXPECT_GT(expected.size(), near.size());
    a.expect(first);
    b.expect(second);
    EXPECT_EQ(sorted(finder.between(a, b, kDistance), false), expected);
    a.move(Points(a.positions()), pool);
    b.move(Points(b.positions()), pool);
    EXPECT_EQ(sorted(finder.between(a, b, kDistance), false), near);
  }
  EXPECT_EQ(kind_of([&] { a.expect(VectorX::Zero(3)); }), ErrorKind::wrong_shape);
}

TEST(TrianglePairs, DoNotDependOnThreads) {
  Random random(22);
  const TestSurface sphere = unit_sphere(14);
  const Points moved = shaken(sphere.nodes, random, 0.02);
  std::vector<TrianglePair> expected_between, expected_within;
  for (const int threads : {1, 2, 3, 5}) {
    ThreadPool pool(threads);
    TrianglePairs finder(pool);
    SurfaceTree a(sphere.topology()), b(sphere.topology());
    a.move(sphere.nodes, pool);
    b.move(placed(moved, Matrix3::Identity(), {1.8, 0.1, 0.0}), pool);
    const auto between = finder.between(a, b, 0.1);
    const std::vector<TrianglePair> found(between.begin(), between.end());
    const auto within = finder.within(a, 0.05);
    const std::vector<TrianglePair> own(within.begin(), within.end());
    if (threads == 1) {
      expected_between = found;
      expected_within = own;
      EXPECT_GT(found.size(), 100u);
    }
    EXPECT_EQ(found, expected_between);
    EXPECT_EQ(own, expected_within);
  }
}

TEST(SurfaceTree, IsBuiltAnewWhenDegraded) {
  Random random(23);
  ThreadPool pool;
  TestSurface sphere = unit_sphere(8);
  SurfaceTree tree(sphere.topology());
  tree.move(sphere.nodes, pool);
  EXPECT_EQ(tree.builds(), 1);
  // A similarity motion and a small deformation keep the tree.
  tree.move(placed(sphere.nodes, Matrix3::Identity(), {5, 5, 5}, 3.0), pool);
  tree.move(shaken(sphere.nodes, random, 0.01), pool);
  EXPECT_EQ(tree.builds(), 1);
  const double cost = tree.cost();
  // When the surface is crumpled, the boxes overlap whatever their order: the tree is rebuilt.
  tree.move(shaken(sphere.nodes, random, 1.0), pool);
  EXPECT_EQ(tree.builds(), 2);
  tree.move(sphere.nodes, pool);
  EXPECT_EQ(tree.builds(), 3);
  EXPECT_LT(tree.cost(), 1.2 * cost);
}

TEST(NearestOnSurface, IsThatOfAllTriangles) {
  Random random(24);
  ThreadPool pool;
  const TestSurface ring = torus(1.0, 0.4, 18, 9);
  SurfaceTree tree(ring.topology());
  tree.move(shaken(ring.nodes, random, 0.05), pool);
  for (int trial = 0; trial < 300; ++trial) {
    const Vector3 point = random_point(random, 2.0);
    double least = kInfinity;
    for (int t = 0; t < static_cast<int>(ring.triangles.size()); ++t) {
      const Corners x = tree.corners(t);
      least = std::min(least, (closest_on_triangle(point, x[0], x[1], x[2]).point - point).norm());
    }
    const NearestOnSurface nearest = nearest_on_surface(tree, point);
    EXPECT_NEAR(nearest.distance, least, 1e-15);
    const Corners x = tree.corners(nearest.triangle);
    const Vector3& w = nearest.weights;
    EXPECT_NEAR((w[0] * x[0] + w[1] * x[1] + w[2] * x[2] - nearest.point).norm(), 0.0, 1e-15);
    EXPECT_NEAR((nearest.point - point).norm(), least, 1e-15);
    EXPECT_EQ(nearest_on_surface(tree, point, 0.9 * least).triangle, -1);
    EXPECT_EQ(nearest_on_surface(tree, point, 1.1 * least).triangle, nearest.triangle);
  }
}

TEST(NearestOnSurface, TakesTheLowestOfEqualTriangles) {
  ThreadPool pool;
  const TestSurface box = unit_box(2);
  SurfaceTree tree(box.topology());
  tree.move(box.nodes, pool);
  const NodeId corner = box.triangles[5][1];
  EXPECT_EQ(nearest_on_surface(tree, tree.at(corner)).triangle,
            tree.topology().triangles_of_node(corner).front());
}

// Winding number as the sum of solid angles over 4 pi (van Oosterom & Strackee 1983): an
// independent method.
double winding_by_angles(const SurfaceTree& tree, const Vector3& point) {
  double sum = 0.0;
  for (int t = 0; t < static_cast<int>(tree.topology().triangles().size()); ++t) {
    const Corners x = tree.corners(t);
    const Vector3 a = x[0] - point, b = x[1] - point, c = x[2] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4.0 * std::numbers::pi);
}

TEST(WindingNumber, IsTheSumOfTheSolidAngles) {
  Random random(25);
  ThreadPool pool;
  // A ring perturbed until it overlaps itself, with a ball that reaches into it.
  const TestSurface surface = joined(torus(1.0, 0.4, 18, 9), unit_sphere(4));
  SurfaceTree tree(surface.topology());
  std::set<int> seen;
  for (const double shake : {0.0, 0.05, 0.6}) {
    tree.move(shaken(surface.nodes, random, shake), pool);
    for (int trial = 0; trial < 400; ++trial) {
      const Vector3 point = random_point(random, 1.5);
      const int winding = winding_number(tree, point);
      EXPECT_NEAR(winding, winding_by_angles(tree, point), 1e-9);
      seen.insert(winding);
    }
  }
  for (const int winding : {-1, 0, 1, 2}) EXPECT_TRUE(seen.contains(winding)) << winding;
}

TEST(WindingNumber, OfRaysThroughEdgesAndVertices) {
  // Rays from the lattice points pass along faces and through edges, vertices and diagonals.
  ThreadPool pool;
  const TestSurface box = unit_box(4);
  SurfaceTree tree(box.topology());
  tree.move(box.nodes, pool);
  for (int i = -2; i <= 10; ++i) {
    for (int j = -2; j <= 10; ++j) {
      for (int k = -2; k <= 10; ++k) {
        const Vector3 point = Vector3(i, j, k) / 8.0;
        const double low = point.minCoeff(), high = point.maxCoeff();
        const bool inside = low > 0.0 && high < 1.0;
        if (!inside && low >= 0.0 && high <= 1.0) continue;  // on the surface
        EXPECT_EQ(winding_number(tree, point), inside ? 1 : 0);
      }
    }
  }
}

}  // namespace
}  // namespace sinew::collision
