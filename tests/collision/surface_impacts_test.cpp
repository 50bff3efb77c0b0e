#include "sinew/collision/surface_impacts.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/collision/impact.hpp"

#include "surfaces.hpp"

namespace sinew::collision {
namespace {

using namespace testing;

using Entry = std::tuple<FeatureKind, int, FeatureKind, int, double>;

std::vector<Entry> sorted(std::span<const SurfaceImpact> impacts, bool unordered = false) {
  std::vector<Entry> result;
  for (const SurfaceImpact& x : impacts) {
    Entry entry{x.first_kind, x.first, x.second_kind, x.second, x.time};
    // Within one surface, vertex and face may come in either order, and so may two edges.
    if (unordered && x.first_kind == FeatureKind::face) {
      entry = {x.second_kind, x.second, x.first_kind, x.first, x.time};
    }
    if (unordered && x.first_kind == FeatureKind::edge && x.first > x.second) {
      entry = {x.second_kind, x.second, x.first_kind, x.first, 0.0};
    }
    if (unordered) std::get<4>(entry) = 0.0;
    result.push_back(entry);
  }
  std::ranges::sort(result);
  return result;
}

// Brute force: all vertices with all faces, and all edges with all edges.
std::vector<Entry> by_force(const SurfaceTree& a, const SurfaceTree& b, double separation) {
  std::vector<Entry> result;
  const auto add_faces = [&](const SurfaceTree& own, const SurfaceTree& other, bool swapped) {
    const auto& triangles = other.topology().triangles();
    for (int node = 0; node < own.topology().node_count(); ++node) {
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        FourPoints start{own.at(node)}, end{own.at_end(node)};
        for (std::size_t k = 0; k < 3; ++k) {
          start[k + 1] = other.at(triangles[t][k]);
          end[k + 1] = other.at_end(triangles[t][k]);
        }
        if (&a == &b && std::ranges::count(triangles[t], node) > 0) continue;
        const auto time = vertex_face_impact(start, end, separation);
        if (!time) continue;
        if (swapped) {
          result.emplace_back(FeatureKind::face, t, FeatureKind::vertex, node, *time);
        } else {
          result.emplace_back(FeatureKind::vertex, node, FeatureKind::face, t, *time);
        }
      }
    }
  };
  add_faces(a, b, false);
  if (&a != &b) add_faces(b, a, true);
  const auto& edges = a.topology().edges();
  const auto& others = b.topology().edges();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (std::size_t f = &a == &b ? e + 1 : 0; f < others.size(); ++f) {
      const auto& [i, j] = edges[e];
      const auto& [k, l] = others[f];
      if (&a == &b && (i == k || i == l || j == k || j == l)) continue;
      const auto time =
          edge_edge_impact({a.at(i), a.at(j), b.at(k), b.at(l)},
                           {a.at_end(i), a.at_end(j), b.at_end(k), b.at_end(l)}, separation);
      if (time) result.emplace_back(FeatureKind::edge, e, FeatureKind::edge, f, *time);
    }
  }
  std::ranges::sort(result);
  return result;
}

TEST(SurfaceImpacts, AreThoseOfAllPairs) {
  Random random(51);
  const TestSurface sphere = unit_sphere(3), ring = torus(1.0, 0.4, 12, 6);
  ThreadPool pool(2);
  SurfaceImpacts search(pool);
  SurfaceTree a(sphere.topology()), b(ring.topology());
  for (int trial = 0; trial < 8; ++trial) {
    const Vector3 from = Vector3(3, 0.2, 0.1);
    a.sweep(placed(sphere.nodes, Matrix3::Identity(), from),
            placed(sphere.nodes, random_rotation(random), from + random_point(random)), pool);
    b.sweep(ring.nodes, shaken(ring.nodes, random, 0.1), pool);
    const double separation = trial % 2 == 0 ? 0.0 : 0.02;
    const auto found = search.between(a, b, separation);
    const auto expected = by_force(a, b, separation);
    ASSERT_EQ(found.size(), expected.size());
    const auto listed = sorted(found);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(listed[k], expected[k]);
    }
    EXPECT_EQ(earliest(found).has_value(), !expected.empty());
  }
}

TEST(SurfaceImpacts, OfOneSurfaceAreThoseOfAllPairs) {
  Random random(52);
  const TestSurface ring = torus(1.0, 0.4, 12, 6);
  ThreadPool pool(2);
  SurfaceImpacts search(pool);
  SurfaceTree tree(ring.topology());
  for (int trial = 0; trial < 4; ++trial) {
    tree.sweep(ring.nodes, shaken(ring.nodes, random, 0.3), pool);
    auto expected = by_force(tree, tree, 0.0);
    for (Entry& entry : expected) std::get<4>(entry) = 0.0;
    EXPECT_EQ(sorted(search.within(tree, 0.0), true), expected);
    EXPECT_FALSE(expected.empty());
  }
}

TEST(SurfaceImpacts, OfABallThatFallsOnASquare) {
  const TestSurface ball = unit_sphere(4), floor = unit_square(4);
  ThreadPool pool;
  SurfaceImpacts search(pool);
  SurfaceTree a(ball.topology()), b(floor.topology());
  const Points start = placed(ball.nodes, Matrix3::Identity(), {0.45, 0.55, 3.0});
  a.sweep(start, placed(start, Matrix3::Identity(), {0, 0, -4.0}), pool);
  b.move(floor.nodes, pool);
  const double lowest = start.col(2).minCoeff();
  EXPECT_NEAR(earliest(search.between(a, b, 0.0)).value(), lowest / 4.0, 1e-12);
  EXPECT_NEAR(earliest(search.between(a, b, 0.1)).value(), (lowest - 0.1) / 4.0, 1e-6);
  // No impact if the motion ends above the floor.
  a.sweep(start, placed(start, Matrix3::Identity(), {0, 0, -0.999 * lowest}), pool);
  EXPECT_FALSE(earliest(search.between(a, b, 0.0)).has_value());
  EXPECT_TRUE(earliest(search.between(a, b, 0.01)).has_value());
}

TEST(SurfaceImpacts, DoNotDependOnThreads) {
  Random random(53);
  const TestSurface ring = torus(1.0, 0.4, 24, 12);
  const Points moved = shaken(ring.nodes, random, 0.2);
  std::vector<SurfaceImpact> expected;
  for (const int threads : {1, 2, 3}) {
    ThreadPool pool(threads);
    SurfaceImpacts search(pool);
    SurfaceTree tree(ring.topology());
    tree.sweep(ring.nodes, moved, pool);
    const auto found = search.within(tree, 0.01);
    if (threads == 1) expected.assign(found.begin(), found.end());
    ASSERT_EQ(found.size(), expected.size());
    EXPECT_GT(found.size(), 100u);
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].first, expected[k].first);
      EXPECT_EQ(found[k].second, expected[k].second);
      EXPECT_EQ(found[k].time, expected[k].time);
    }
  }
}

}  // namespace
}  // namespace sinew::collision
