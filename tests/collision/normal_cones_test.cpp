#include "sinew/collision/normal_cones.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/collision/proximity.hpp"

#include "surfaces.hpp"

namespace sinew::collision {
namespace {

using namespace testing;

// The slack for crossing edges up to which the search uses cones, and the least above it.
constexpr double kWithCones = 1e-6, kWithout = 1.0000001e-6;

TestSurface mapped(TestSurface surface, const std::function<Vector3(const Vector3&)>& map) {
  for (Eigen::Index k = 0; k < surface.nodes.rows(); ++k) {
    surface.nodes.row(k) = map(surface.nodes.row(k).transpose()).transpose();
  }
  return surface;
}

// A ring whose hole is squeezed to a slit.
TestSurface squeezed_ring() {
  return mapped(torus(1.0, 0.4, 28, 12),
                [](const Vector3& x) { return Vector3(x[0], 0.3 * x[1], x[2]); });
}

// A bar with sharp ridges, bent until its ends face each other.
TestSurface bent_bar() {
  return mapped(unit_box(6), [](const Vector3& x) {
    const double angle = 5.8 * x[0], radius = 1.0 + 0.5 * x[1];
    return Vector3(radius * std::cos(angle), radius * std::sin(angle), 0.5 * x[2]);
  });
}

// A ball with valleys whose flanks face each other.
TestSurface ball_with_valleys() {
  return mapped(unit_sphere(12), [](const Vector3& x) -> Vector3 {
    const double wave = std::sin(9.0 * x[0]) * std::sin(9.0 * x[1] + 1.0) + std::cos(9.0 * x[2]);
    return x * (1.0 + 0.2 * wave);
  });
}

class OneSurface {
 public:
  explicit OneSurface(const TestSurface& of) : tree(of.topology()), proximity_(pool_) {
    move(of.nodes);
  }
  void move(const Points& nodes) { tree.move(nodes, pool_); }
  // In the order of their features.
  std::vector<ProximityPair> pairs(const ProximitySettings& settings) {
    const auto found = proximity_.within(tree, settings);
    std::vector<ProximityPair> pairs(found.begin(), found.end());
    std::ranges::sort(pairs, {}, [](const ProximityPair& pair) {
      return std::tuple(pair.first.kind, pair.first.number, pair.second.kind, pair.second.number);
    });
    return pairs;
  }
  // Pairs of triangles within the distance, sorted.
  std::vector<std::pair<int, int>> near(double distance, const NormalCones* cones = nullptr) {
    TrianglePairs search(pool_);
    std::vector<std::pair<int, int>> pairs;
    for (const auto& [first, second] : search.within(tree, distance, cones)) {
      pairs.push_back(std::minmax(first, second));
    }
    std::ranges::sort(pairs);
    return pairs;
  }
  NormalCones cones() {
    NormalCones cones;
    cones.update(tree, pool_);
    return cones;
  }
  // Of the pairs of triangles within the distance.
  double share_excluded(double distance) {
    const NormalCones excluding = cones();
    const auto all = static_cast<double>(near(distance).size());
    return 1.0 - static_cast<double>(near(distance, &excluding).size()) / all;
  }

 private:
  ThreadPool pool_{2};

 public:
  SurfaceTree tree;

 private:
  Proximity proximity_;
};

bool are_same(const ProximityPair& a, const ProximityPair& b) {
  const auto same_point = [](const SurfacePoint& p, const SurfacePoint& q) {
    return p.kind == q.kind && p.number == q.number && p.point == q.point;
  };
  return same_point(a.first, b.first) && same_point(a.second, b.second) && a.normal == b.normal &&
         a.distance == b.distance;
}

TEST(NormalCones, ExcludeNoPair) {
  Random random(71);
  std::size_t pairs_seen = 0;
  for (const TestSurface& shape : {squeezed_ring(), bent_bar(), ball_with_valleys()}) {
    OneSurface surface(shape);
    std::size_t of_shape = 0;
    for (const double shake : {0.0, 0.005, 0.02, 0.08}) {
      surface.move(shaken(shape.nodes, random, shake));
      for (const double distance : {0.05, 0.3}) {
        for (const double depth : {0.0, 0.05}) {
          for (const double slack : {0.0, 0.5, 1.0}) {
            ProximitySettings settings{.distance = distance, .depth = depth, .slack = slack};
            settings.edge_slack = kWithout;
            const auto all = surface.pairs(settings);
            settings.edge_slack = kWithCones;
            const auto found = surface.pairs(settings);
            of_shape += all.size();
            ASSERT_EQ(found.size(), all.size()) << shake << ' ' << distance << ' ' << slack;
            for (std::size_t k = 0; k < all.size(); ++k) ASSERT_TRUE(are_same(found[k], all[k]));
          }
        }
      }
    }
    EXPECT_GT(of_shape, 500u);
    pairs_seen += of_shape;
  }
  EXPECT_GT(pairs_seen, 5000u);
}

TEST(NormalCones, OfBranchesExcludePairsThatThoseOfTrianglesExclude) {
  Random random(72);
  for (const TestSurface& shape : {squeezed_ring(), bent_bar(), ball_with_valleys()}) {
    OneSurface surface(shape);
    for (const double shake : {0.0, 0.01}) {
      surface.move(shaken(shape.nodes, random, shake));
      const NormalCones cones = surface.cones();
      auto pairs = surface.near(0.2);
      const std::size_t all = pairs.size();
      std::erase_if(pairs, [&](const auto& p) { return cones.are_averse(p.first, p.second); });
      EXPECT_LT(pairs.size(), all);
      EXPECT_EQ(surface.near(0.2, &cones), pairs);
    }
  }
}

TEST(NormalCones, ExcludeNeighboursOnASmoothSurface) {
  OneSurface ring(torus(1.0, 0.4, 80, 40));
  EXPECT_GT(ring.share_excluded(0.05), 0.9);
  OneSurface box(unit_box(20));  // its ridges have wide cones
  EXPECT_GT(box.share_excluded(0.05), 0.6);
}

TEST(NormalCones, ExcludeNothingOnAnOpenSurface) {
  OneSurface square(unit_square(8));
  EXPECT_EQ(square.share_excluded(0.05), 0.0);
}

TEST(NormalCones, ExcludeNothingNextToATriangleWithoutArea) {
  TestSurface box = unit_box(2);
  box.nodes.row(box.triangles[0][1]) = box.nodes.row(box.triangles[0][0]);
  OneSurface surface(box);
  const NormalCones cones = surface.cones();
  for (int t = 0; t < static_cast<int>(box.triangles.size()); ++t) {
    EXPECT_FALSE(cones.are_averse(0, t));
  }
}

}  // namespace
}  // namespace sinew::collision
