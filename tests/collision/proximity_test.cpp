#include "sinew/collision/proximity.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/collision/closest_points.hpp"
#include "sinew/collision/point_query.hpp"

#include "surfaces.hpp"

namespace sinew::collision {
namespace {

using namespace testing;

class TwoSurfaces {
 public:
  TwoSurfaces(const TestSurface& a, const TestSurface& b)
      : first(a.topology()), second(b.topology()), proximity_(pool_) {
    place(a.nodes, b.nodes);
  }
  void place(const Points& a, const Points& b) {
    first.move(a, pool_);
    second.move(b, pool_);
  }
  std::vector<ProximityPair> pairs(const ProximitySettings& settings) {
    const auto found = proximity_.between(first, second, settings);
    return {found.begin(), found.end()};
  }
  std::vector<ProximityPair> own_pairs(const ProximitySettings& settings) {
    const auto found = proximity_.within(first, settings);
    return {found.begin(), found.end()};
  }
  std::vector<ProximityPair> crossings(const std::vector<std::array<int, 2>>& edges,
                                       const ProximitySettings& settings) {
    const auto found = proximity_.crossings(first, second, edges, settings);
    return {found.begin(), found.end()};
  }

 private:
  ThreadPool pool_{2};

 public:
  SurfaceTree first, second;

 private:
  Proximity proximity_;
};

// Checks that the members of a pair are consistent with each other.
void expect_consistent(const ProximityPair& pair, const SurfaceTree& a, const SurfaceTree& b) {
  const auto place = [](const SurfaceTree& tree, const SurfacePoint& on) -> Vector3 {
    Vector3 x = Vector3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      if (on.nodes[k] >= 0) x += on.weights[static_cast<Eigen::Index>(k)] * tree.at(on.nodes[k]);
    }
    return x;
  };
  EXPECT_LE((place(a, pair.first) - pair.first.point).norm(), 1e-14);
  EXPECT_LE((place(b, pair.second) - pair.second.point).norm(), 1e-14);
  EXPECT_NEAR(pair.first.weights.sum(), 1.0, 1e-14);
  EXPECT_NEAR(pair.normal.norm(), 1.0, 1e-14);
  const Vector3 gap = pair.first.point - pair.second.point;
  EXPECT_LE((gap - pair.distance * pair.normal).norm(), 1e-13);
}

using Name = std::tuple<FeatureKind, int, FeatureKind, int>;

Name name_of(const ProximityPair& pair) {
  return {pair.first.kind, pair.first.number, pair.second.kind, pair.second.number};
}

void expect_once(const std::vector<ProximityPair>& pairs) {
  std::set<Name> names;
  for (const ProximityPair& pair : pairs) EXPECT_TRUE(names.insert(name_of(pair)).second);
}

std::map<std::pair<FeatureKind, FeatureKind>, int> kinds(const std::vector<ProximityPair>& pairs) {
  std::map<std::pair<FeatureKind, FeatureKind>, int> count;
  for (const ProximityPair& pair : pairs) ++count[{pair.first.kind, pair.second.kind}];
  return count;
}

constexpr auto kVertex = FeatureKind::vertex;
constexpr auto kEdge = FeatureKind::edge;
constexpr auto kFace = FeatureKind::face;

double least_distance(const SurfaceTree& a, const SurfaceTree& b) {
  double least = kInfinity;
  for (int i = 0; i < static_cast<int>(a.topology().triangles().size()); ++i) {
    for (int j = 0; j < static_cast<int>(b.topology().triangles().size()); ++j) {
      const Corners x = a.corners(i), y = b.corners(j);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto distance = [&](const Vector3& p, const Corners& t) {
          return (closest_on_triangle(p, t[0], t[1], t[2]).point - p).norm();
        };
        least = std::min({least, distance(x[k], y), distance(y[k], x)});
        for (std::size_t l = 0; l < 3; ++l) {
          const OnEdges on = closest_on_edges(x[k], x[(k + 1) % 3], y[l], y[(l + 1) % 3]);
          least = std::min(least, (on.first_point - on.second_point).norm());
        }
      }
    }
  }
  return least;
}

TEST(Proximity, OfConvexBodiesIsTheirDistance) {
  Random random(31);
  const TestSurface box = unit_box(2), small = unit_box(1);
  TwoSurfaces bodies(box, small);
  std::set<std::pair<FeatureKind, FeatureKind>> seen;
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3 middle = Vector3::Constant(0.5);
    const Matrix3 turned = random_rotation(random), other = random_rotation(random);
    const Vector3 away = random_point(random).normalized() * random.uniform(1.8, 2.5);
    bodies.place(placed(box.nodes, turned, -turned * middle),
                 placed(small.nodes, other, away - other * middle));
    const double least = least_distance(bodies.first, bodies.second);
    const auto pairs = bodies.pairs({.distance = 3.0});
    ASSERT_EQ(pairs.size(), 1u);  // the only local minimum
    EXPECT_NEAR(pairs[0].distance, least, 1e-13);
    expect_consistent(pairs[0], bodies.first, bodies.second);
    seen.insert({pairs[0].first.kind, pairs[0].second.kind});
    EXPECT_EQ(bodies.pairs({.distance = 0.999 * least}).size(), 0u);
  }
  EXPECT_TRUE(seen.contains({kVertex, kFace}) && seen.contains({kFace, kVertex}));
  EXPECT_TRUE(seen.contains({kEdge, kEdge}));
}

TEST(Proximity, VertexOverEverything) {
  // A box corner points down at a square divided by a cross of edges.
  TestSurface tip = unit_box(1);
  const TestSurface floor = unit_square(2);
  const Matrix3 on_tip =
      Eigen::Quaterniond::FromTwoVectors(Vector3(1, 1, 1), Vector3::UnitZ()).toRotationMatrix();
  TwoSurfaces bodies(tip, floor);
  const auto at = [&](double x, double y) {
    bodies.place(placed(tip.nodes, on_tip, {x, y, 0.125}), floor.nodes);
    const auto pairs = bodies.pairs({.distance = 0.2});
    EXPECT_EQ(pairs.size(), 1u) << x << ' ' << y;
    if (pairs.empty()) return FeatureKind::vertex;
    EXPECT_NEAR(pairs[0].distance, 0.125, 1e-15);
    EXPECT_EQ(pairs[0].first.kind, kVertex);
    return pairs[0].second.kind;
  };
  EXPECT_EQ(at(0.3, 0.2), kFace);
  EXPECT_EQ(at(0.5, 0.2), kEdge);
  EXPECT_EQ(at(0.25, 0.25), kEdge);  // on a diagonal
  EXPECT_EQ(at(0.5, 0.5), kVertex);
  for (const double beside : {1e-12, 1e-9, 3e-9, 1e-8, 1e-6}) {
    at(0.5 + beside, 0.2);
    at(0.5 - beside, 0.2);
    at(0.5 + beside, 0.5 + beside);
    at(0.5 + beside, 0.5 - 0.3 * beside);
  }
}

TEST(Proximity, RidgesThatCross) {
  // Two boxes rotated onto an edge: the upper ridge, along x, crosses above the lower one, along y.
  const TestSurface box = unit_box(1);
  TwoSurfaces bodies(box, box);
  constexpr double kTurn = 0.25 * std::numbers::pi;
  const Matrix3 along_x = Eigen::AngleAxisd(kTurn, Vector3::UnitX()).matrix();
  const Matrix3 along_y = Eigen::AngleAxisd(kTurn, Vector3::UnitY()).matrix();
  // The upper ridge starts at (x, 0), the lower one at (0, y), 0.125 below.
  const auto at = [&](double x, double y) {
    bodies.place(placed(box.nodes, along_x, {x, 0.0, 0.125}),
                 placed(box.nodes, along_y, {-std::sqrt(0.5), y, -std::sqrt(0.5)}));
    const auto pairs = bodies.pairs({.distance = 0.2});
    EXPECT_EQ(pairs.size(), 1u) << x << ' ' << y;
    if (pairs.empty()) return std::pair(kFace, kFace);
    EXPECT_NEAR(pairs[0].distance, 0.125, 1e-15);
    EXPECT_NEAR(pairs[0].normal[2], 1.0, 1e-13);
    return std::pair(pairs[0].first.kind, pairs[0].second.kind);
  };
  EXPECT_EQ(at(-0.2, -0.7), std::pair(kEdge, kEdge));
  EXPECT_EQ(at(0.0, -0.7), std::pair(kVertex, kEdge));
  EXPECT_EQ(at(-1.0, -0.7), std::pair(kVertex, kEdge));
  EXPECT_EQ(at(-0.2, 0.0), std::pair(kEdge, kVertex));
  EXPECT_EQ(at(0.0, -1.0), std::pair(kVertex, kVertex));
  for (const double beside : {1e-12, 1e-9, 3e-9, 1e-8}) {
    at(-beside, -0.7);
    at(beside, -0.7);
    at(-beside, -beside);
  }
}

TEST(Proximity, FaceOnFaceIsFoundOnceAtEveryVertex) {
  const TestSurface box = unit_box(2);
  TwoSurfaces bodies(box, box);
  bodies.place(placed(box.nodes, Matrix3::Identity(), {0.3, 0.2, 1.125}), box.nodes);
  const auto pairs = bodies.pairs({.distance = 0.2});
  expect_once(pairs);
  for (const ProximityPair& pair : pairs) {
    EXPECT_NEAR(pair.distance, 0.125, 1e-15);
    EXPECT_NEAR(pair.normal[2], 1.0, 1e-15);
    expect_consistent(pair, bodies.first, bodies.second);
  }
  // Four of the nine vertices of the upper face lie over the lower box, and vice versa.
  const auto vertices = [&](bool first) {
    return std::ranges::count_if(pairs, [&](const ProximityPair& pair) {
      return (first ? pair.first : pair.second).kind == kVertex;
    });
  };
  EXPECT_EQ(vertices(true), 4);
  EXPECT_EQ(vertices(false), 4);
}

TEST(Proximity, FaceOnEqualFaceHasAPairAtEachVertex) {
  const TestSurface box = unit_box(2);
  TwoSurfaces bodies(box, box);
  bodies.place(placed(box.nodes, Matrix3::Identity(), {0.0, 0.0, 1.125}), box.nodes);
  const auto pairs = bodies.pairs({.distance = 0.2});
  expect_once(pairs);
  const auto count = kinds(pairs);
  EXPECT_EQ(count.at({kVertex, kVertex}), 9);
  EXPECT_FALSE(count.contains({kVertex, kFace}) || count.contains({kVertex, kEdge}));
}

// Alternating projection onto the two surfaces, which ends in a local minimum of the distance.
std::pair<Vector3, Vector3> settle(const SurfaceTree& a, const SurfaceTree& b, Vector3 p) {
  Vector3 q = p;
  for (int k = 0; k < 3000; ++k) {
    q = nearest_on_surface(b, p).point;
    const Vector3 next = nearest_on_surface(a, q).point;
    if ((next - p).norm() < 1e-15) break;
    p = next;
  }
  return {p, q};
}

TEST(Proximity, HoldsEveryMinimumThatAWalkEndsIn) {
  Random random(32);
  const TestSurface ring = torus(1.0, 0.4, 16, 8);
  TwoSurfaces bodies(ring, ring);
  int found = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix3 turned = random_rotation(random);
    bodies.place(shaken(ring.nodes, random, 0.05),
                 placed(shaken(ring.nodes, random, 0.05), turned, random_point(random, 2.5)));
    const double distance = least_distance(bodies.first, bodies.second);
    if (distance < 0.05) continue;
    const auto pairs = bodies.pairs({.distance = 4.0});
    expect_once(pairs);
    for (const ProximityPair& pair : pairs) {
      expect_consistent(pair, bodies.first, bodies.second);
    }
    for (int start = 0; start < 30; ++start) {
      const Vector3 from = bodies.first.at(random_integer(random, 127));
      const auto [p, q] = settle(bodies.first, bodies.second, from);
      const bool known = std::ranges::any_of(pairs, [&, p = p, q = q](const ProximityPair& pair) {
        return (pair.first.point - p).norm() < 1e-6 && (pair.second.point - q).norm() < 1e-6;
      });
      EXPECT_TRUE(known) << (p - q).norm();
      ++found;
    }
  }
  EXPECT_GT(found, 100);
}

TEST(Proximity, EveryPairIsALocalMinimum) {
  // No pair of points sampled nearby, on the adjacent triangles, is nearer.
  Random random(33);
  const TestSurface ring = torus(1.0, 0.4, 16, 8);
  TwoSurfaces bodies(ring, ring);
  const auto around = [](const SurfaceTree& tree, const SurfacePoint& on) {
    std::set<int> triangles;
    const SurfaceTopology& topology = tree.topology();
    if (on.kind == kFace) triangles.insert(on.number);
    if (on.kind == kEdge) {
      for (const int t : topology.triangles_of_edge(on.number)) triangles.insert(t);
    }
    if (on.kind == kVertex) {
      for (const int t : topology.triangles_of_node(on.number)) triangles.insert(t);
    }
    return std::vector<int>(triangles.begin(), triangles.end());
  };
  const auto step = [&](const SurfaceTree& tree, const SurfacePoint& on) -> Vector3 {
    const auto triangles = around(tree, on);
    const auto t =
        static_cast<std::size_t>(random_integer(random, static_cast<int>(triangles.size()) - 1));
    const Corners x = tree.corners(triangles[t]);
    const Vector3 w = Vector3(random.uniform(), random.uniform(), random.uniform());
    return on.point + 1e-6 * ((w[0] * x[0] + w[1] * x[1] + w[2] * x[2]) / w.sum() - on.point);
  };
  int pairs_seen = 0;
  for (int trial = 0; trial < 30; ++trial) {
    bodies.place(shaken(ring.nodes, random, 0.05),
                 placed(shaken(ring.nodes, random, 0.05), random_rotation(random),
                        random_point(random, 2.5)));
    for (const ProximityPair& pair : bodies.pairs({.distance = 1.5})) {
      ++pairs_seen;
      for (int sample = 0; sample < 60; ++sample) {
        const Vector3 p = step(bodies.first, pair.first), q = step(bodies.second, pair.second);
        ASSERT_GE((p - q).norm(), pair.distance - 1e-14);
      }
    }
  }
  EXPECT_GT(pairs_seen, 30);
}

TEST(Proximity, SlackLetsMoreIn) {
  const TestSurface sphere = unit_sphere(8);
  TwoSurfaces bodies(sphere, sphere);
  bodies.place(placed(sphere.nodes, Matrix3::Identity(), {2.1, 0.04, 0.03}), sphere.nodes);
  const auto strict = bodies.pairs({.distance = 0.3});
  const auto loose = bodies.pairs({.distance = 0.3, .slack = 0.3});
  const auto all = bodies.pairs({.distance = 0.3, .slack = 1.0});
  EXPECT_GE(strict.size(), 1u);
  EXPECT_GT(loose.size(), strict.size());
  EXPECT_GT(all.size(), loose.size());
  expect_once(all);
  const auto holds = [](const std::vector<ProximityPair>& set, const ProximityPair& pair) {
    return std::ranges::any_of(set, [&](const auto& x) { return name_of(x) == name_of(pair); });
  };
  for (const ProximityPair& pair : strict) EXPECT_TRUE(holds(loose, pair));
  for (const ProximityPair& pair : loose) EXPECT_TRUE(holds(all, pair));
}

// Only the half x >= 0.5 of a box is expected to reach the other one.
TEST(Proximity, PairsReachAsFarAsTheirFeaturesMove) {
  const TestSurface box = unit_box(4);
  TwoSurfaces bodies(box, box);
  bodies.place(placed(box.nodes, Matrix3::Identity(), {0.03, 0.04, 1.1}), box.nodes);
  const ProximitySettings near{.distance = 0.05, .slack = 0.5}, far{.distance = 0.12, .slack = 0.5};
  EXPECT_TRUE(bodies.pairs(near).empty());
  const auto all = bodies.pairs(far);
  VectorX motion = VectorX::Zero(box.nodes.rows());
  for (Eigen::Index k = 0; k < motion.size(); ++k) motion[k] = box.nodes(k, 0) < 0.5 ? 0.0 : 0.06;
  bodies.first.expect(motion);
  bodies.second.expect(motion);
  const auto found = bodies.pairs(near);
  expect_once(found);
  std::set<Name> names;
  for (const ProximityPair& pair : found) {
    names.insert(name_of(pair));
    EXPECT_GT(pair.first.point[0], 0.25);
    EXPECT_GT(pair.distance, near.distance);
  }
  int moving = 0;
  std::set<Name> possible;
  for (const ProximityPair& pair : all) {
    possible.insert(name_of(pair));
    if (pair.first.point[0] < 0.79) continue;
    EXPECT_TRUE(names.contains(name_of(pair)));
    ++moving;
  }
  EXPECT_GT(moving, 5);
  EXPECT_TRUE(std::ranges::includes(possible, names));
}

// Two spheres: the crossings near the nearest one are those that a slack lets in. Edges that cross
// beyond their ends, or too far from each other, form no pair.
TEST(Proximity, CrossingsOfGivenEdges) {
  const TestSurface sphere = unit_sphere(8);
  TwoSurfaces bodies(sphere, sphere);
  bodies.place(placed(sphere.nodes, Matrix3::Identity(), {2.1, 0.04, 0.03}), sphere.nodes);
  const ProximitySettings settings{.distance = 0.3, .slack = 0.5, .edge_slack = 1e-9};
  const auto all = bodies.pairs({.distance = 0.3, .slack = 1.0});
  std::vector<std::array<int, 2>> edges;
  std::vector<ProximityPair> expected;
  for (const ProximityPair& pair : all) {
    if (pair.first.kind != kEdge || pair.second.kind != kEdge) continue;
    expected.push_back(pair);
    edges.push_back({pair.first.number, pair.second.number});
  }
  EXPECT_GT(expected.size(),
            static_cast<std::size_t>(kinds(bodies.pairs(settings))[{kEdge, kEdge}]));
  const auto found = bodies.crossings(edges, settings);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(name_of(found[k]), name_of(expected[k]));
    EXPECT_LE((found[k].first.point - expected[k].first.point).norm(), 1e-14);
    EXPECT_LE((found[k].normal - expected[k].normal).norm(), 1e-14);
    EXPECT_NEAR(found[k].distance, expected[k].distance, 1e-14);
    expect_consistent(found[k], bodies.first, bodies.second);
  }
  const double nearest = std::ranges::min(expected, {}, &ProximityPair::distance).distance;
  EXPECT_TRUE(bodies.crossings(edges, {.distance = 0.9 * nearest}).empty());
  std::vector<std::array<int, 2>> every;
  const int count = static_cast<int>(bodies.first.topology().edges().size());
  for (int e = 0; e < count; ++e) every.push_back({edges.front()[0], e});
  for (const ProximityPair& pair : bodies.crossings(every, settings)) {
    EXPECT_TRUE(std::ranges::any_of(
        expected, [&](const ProximityPair& other) { return name_of(other) == name_of(pair); }));
  }
}

TEST(Proximity, OfOneSurfaceWithItself) {
  // A plate bent to a C: its ends face each other across 0.2, and the wall is 0.05 thick.
  TestSurface plate = unit_box(16);
  const Points flat = plate.nodes;
  const auto bend = [&](double angle) {
    for (Eigen::Index k = 0; k < flat.rows(); ++k) {
      const double turn = angle * (flat(k, 0) - 0.5), radius = 1.0 - 0.05 * flat(k, 2);
      plate.nodes.row(k) << radius * std::sin(turn), 0.3 * flat(k, 1), -radius * std::cos(turn);
    }
  };
  bend(0.97 * 2.0 * std::numbers::pi);
  TwoSurfaces bodies(plate, plate);
  const double gap = 2.0 * std::sin(0.03 * std::numbers::pi);
  const auto pairs = bodies.own_pairs({.distance = 1.1 * gap});
  expect_once(pairs);
  ASSERT_FALSE(pairs.empty());
  double least = kInfinity;
  for (const ProximityPair& pair : pairs) {
    expect_consistent(pair, bodies.first, bodies.first);
    least = std::min(least, pair.distance);
    EXPECT_GT(std::abs(pair.normal[0]), 0.9);  // across the slit, not through the wall
    for (const NodeId node : pair.first.nodes) {
      EXPECT_TRUE(node < 0 || std::ranges::count(pair.second.nodes, node) == 0);
    }
  }
  // The inner corners of the ends, at radius 0.95, are nearest to each other.
  EXPECT_NEAR(least, 0.95 * gap, 1e-12);
  // Pairs through the wall are reported only on request.
  const auto through = bodies.own_pairs({.distance = 0.06, .facing = false});
  EXPECT_TRUE(std::ranges::any_of(
      through, [](const ProximityPair& pair) { return std::abs(pair.distance - 0.05) < 0.002; }));
  EXPECT_TRUE(bodies.own_pairs({.distance = 0.06}).empty());
}

TEST(Proximity, DoesNotDependOnThreads) {
  Random random(34);
  const TestSurface sphere = unit_sphere(12);
  const Points rough = shaken(sphere.nodes, random, 0.02);
  std::vector<ProximityPair> expected;
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    Proximity proximity(pool);
    SurfaceTree a(sphere.topology()), b(sphere.topology());
    a.move(rough, pool);
    b.move(placed(rough, Matrix3::Identity(), {2.05, 0.1, 0.0}), pool);
    const auto found = proximity.between(a, b, {.distance = 0.3, .slack = 0.5});
    if (threads == 1) expected.assign(found.begin(), found.end());
    ASSERT_EQ(found.size(), expected.size());
    EXPECT_GT(found.size(), 20u);
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(name_of(found[k]), name_of(expected[k]));
      EXPECT_EQ(found[k].first.point, expected[k].first.point);
      EXPECT_EQ(found[k].distance, expected[k].distance);
    }
  }
}

// Two boxes with non-matching meshes are stacked, then pushed slightly into each other: the same
// pairs face each other, and their distances continue below zero.
TEST(Proximity, OverlapsGoOnFromGaps) {
  TestSurface low = unit_box(3), top = unit_box(4);
  const Eigen::AngleAxisd turn(0.3, Vector3::UnitZ());
  for (Eigen::Index k = 0; k < top.nodes.rows(); ++k) {
    top.nodes.row(k) =
        (turn * (0.6 * top.nodes.row(k).transpose()) + Vector3(0.3, 0.1, 0)).transpose();
  }
  const auto at = [&](double height) {
    Points nodes = top.nodes;
    nodes.col(2).array() += 1.0 + height;
    TwoSurfaces bodies(low, {nodes, top.triangles});
    std::map<Name, ProximityPair> result;
    const auto found =
        bodies.pairs({.distance = 0.05, .depth = 0.05, .slack = 0.5, .edge_slack = 1e-9});
    expect_once(found);
    for (const ProximityPair& pair : found) {
      expect_consistent(pair, bodies.first, bodies.second);
      result.emplace(name_of(pair), pair);
    }
    return result;
  };
  const auto apart = at(1e-3), through = at(-1e-3);
  ASSERT_GT(apart.size(), 20U);
  std::size_t common = 0;
  for (const auto& [name, pair] : apart) {
    const auto found = through.find(name);
    if (found == through.end()) continue;
    ++common;
    EXPECT_NEAR(pair.distance, 1e-3, 1e-12);
    EXPECT_NEAR(found->second.distance, -1e-3, 1e-12);
    EXPECT_LE((found->second.normal - pair.normal).norm(), 1e-9);
  }
  EXPECT_EQ(common, apart.size());
  // No pair takes the way out through a side face, which is farther away than the top.
  for (const auto& [name, pair] : through) EXPECT_NEAR(pair.distance, -1e-3, 1e-12);
}

// Boxes with flush sides touch only with the faces that meet: at a distance, in contact, and
// overlapping. The side faces, in whose planes the rims lie, give no pairs.
TEST(Proximity, FlushBoxesMeetAcrossTheirFaces) {
  const TestSurface box = unit_box(2);
  for (const double offset : {0.0, 0.3}) {
    std::set<Name> before;
    for (const double height : {1e-3, 1e-9, 0.0, -1e-9, -1e-3}) {
      TwoSurfaces bodies(box, box);
      bodies.place(placed(box.nodes, Matrix3::Identity(), {offset, 0.0, 1.0 + height}), box.nodes);
      const auto found =
          bodies.pairs({.distance = 0.05, .depth = 0.05, .slack = 0.5, .edge_slack = 1e-9});
      expect_once(found);
      std::set<Name> vertices;
      for (const ProximityPair& pair : found) {
        EXPECT_NEAR(pair.distance, height, 1e-12) << offset << " " << height;
        EXPECT_LE((pair.normal - Vector3::UnitZ()).norm(), 1e-6) << offset << " " << height;
        if (pair.first.kind == kVertex || pair.second.kind == kVertex) {
          vertices.insert(name_of(pair));
        }
      }
      EXPECT_GE(vertices.size(), 9U) << offset << " " << height;
      if (before.empty()) before = vertices;
      EXPECT_EQ(vertices, before) << offset << " " << height;
    }
  }
}

// Crossing ridges give a pair of edges, before and after they touch.
TEST(Proximity, CrossingRidgesPassEachOther) {
  const auto ridge = [](const Vector3& axis, double height) {
    TestSurface box = unit_box(1);
    const Eigen::AngleAxisd lean(M_PI / 4, axis);
    for (Eigen::Index k = 0; k < box.nodes.rows(); ++k) {
      Vector3 x = box.nodes.row(k).transpose();
      x += Vector3(-0.5, -0.5, -0.5);
      x = lean * x;
      box.nodes.row(k) = (x + Vector3(0, 0, height)).transpose();
    }
    return box;
  };
  for (const double gap : {2e-3, -2e-3}) {
    TwoSurfaces bodies(ridge(Vector3::UnitX(), 0.0), ridge(Vector3::UnitY(), std::sqrt(2.0) + gap));
    const auto found =
        bodies.pairs({.distance = 0.01, .depth = 0.01, .slack = 0.5, .edge_slack = 1e-9});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].first.kind, FeatureKind::edge);
    EXPECT_EQ(found[0].second.kind, FeatureKind::edge);
    EXPECT_NEAR(found[0].distance, gap, 1e-12);
    EXPECT_LE((found[0].normal + Vector3::UnitZ()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace sinew::collision
