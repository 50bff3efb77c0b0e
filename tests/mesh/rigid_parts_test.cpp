// Parts of a mesh that can move without deforming: cubes that share a face, an edge, a node or
// nothing, in every kind of element.
#include "sinew/mesh/rigid_parts.hpp"

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "sinew/mesh/check.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/report.hpp"
#include "sinew/mesh/shapes.hpp"

namespace sinew::mesh {
namespace {

using Cell = std::array<int, 3>;
using testing::HasSubstr;

enum class Kind { tetrahedra, quadratic, hexahedra };
constexpr std::array kKinds{Kind::tetrahedra, Kind::quadratic, Kind::hexahedra};
constexpr double kEdge = 0.01;  // m

// Cubes of 10 mm on a grid, with common nodes where they touch.
Mesh cubes(Kind kind, const std::vector<Cell>& cells, double offset = 0.0) {
  Mesh mesh;
  std::map<Cell, NodeId> numbers;
  std::vector<Vector3> nodes;
  const auto node = [&](const Cell& at) {
    const auto [found, added] = numbers.try_emplace(at, static_cast<NodeId>(nodes.size()));
    if (added) nodes.emplace_back(kEdge * at[0] + offset, kEdge * at[1], kEdge * at[2]);
    return found->second;
  };
  for (const auto& [x, y, z] : cells) {
    const Hexahedron corner{node({x, y, z}),
                            node({x + 1, y, z}),
                            node({x + 1, y + 1, z}),
                            node({x, y + 1, z}),
                            node({x, y, z + 1}),
                            node({x + 1, y, z + 1}),
                            node({x + 1, y + 1, z + 1}),
                            node({x, y + 1, z + 1})};
    if (kind == Kind::hexahedra) {
      mesh.hexahedra.push_back(corner);
      continue;
    }
    // Kuhn's six tetrahedra around the diagonal 0-6, which match across faces of the grid.
    constexpr std::array<std::pair<int, int>, 6> kMiddle{
        {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}};
    for (const auto& [a, b] : kMiddle) {
      mesh.tetrahedra.push_back({corner[0], corner[static_cast<std::size_t>(a)],
                                 corner[static_cast<std::size_t>(b)], corner[6]});
    }
  }
  mesh.nodes.resize(static_cast<Eigen::Index>(nodes.size()), 3);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    mesh.nodes.row(static_cast<Eigen::Index>(n)) = nodes[n].transpose();
  }
  check(mesh, {.allow_several_components = true});
  if (kind == Kind::quadratic) mesh = with_middle_nodes(mesh);
  return mesh;
}

// The nodes of the plane x = 0, held in all directions.
std::vector<HeldAxis> clamp(const Mesh& mesh) {
  std::vector<HeldAxis> held;
  for (NodeId n = 0; n < mesh.node_count(); ++n) {
    if (std::abs(mesh.nodes(n, 0)) > 1e-9) continue;
    for (int axis = 0; axis < 3; ++axis) held.push_back({n, axis});
  }
  return held;
}

int elements_per_cube(Kind kind) { return kind == Kind::hexahedra ? 1 : 6; }

TEST(RigidParts, SoundMeshesAreOnePart) {
  for (const Kind kind : kKinds) {
    const Mesh mesh = cubes(kind, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}});
    EXPECT_EQ(rigid_parts(mesh).size(), 1u);
    EXPECT_TRUE(loose_joints(mesh).empty());
    EXPECT_TRUE(loose_joints(mesh, clamp(mesh)).empty());
  }
  EXPECT_EQ(rigid_parts(block({.size = {0.1, 0.1, 0.1}, .cells = {3, 3, 3}})).size(), 1u);
}

TEST(RigidParts, AnEdgeIsAHinge) {
  for (const Kind kind : kKinds) {
    const Mesh mesh = cubes(kind, {{0, 0, 0}, {1, 0, 1}});
    for (const auto& loose : {loose_joints(mesh), loose_joints(mesh, clamp(mesh))}) {
      ASSERT_EQ(loose.size(), 1u) << static_cast<int>(kind);
      EXPECT_EQ(loose[0].elements, elements_per_cube(kind));
      EXPECT_EQ(loose[0].motions, 1);
      EXPECT_LT((loose[0].centre - Vector3(0.015, 0.005, 0.015)).norm(), 1e-12);
      EXPECT_EQ(loose[0].shared.size(), kind == Kind::quadratic ? 3u : 2u);
      const std::string text = describe(loose[0], mesh);
      EXPECT_THAT(text, HasSubstr("along the edge"));
      EXPECT_THAT(text, HasSubstr("(0.01, 0, 0.01)"));
      EXPECT_THAT(text, HasSubstr("(0.01, 0.01, 0.01)"));
    }
    EXPECT_THAT(format_report(describe(mesh)), HasSubstr("loose "));
  }
}

TEST(RigidParts, ANodeIsABallJoint) {
  for (const Kind kind : kKinds) {
    const Mesh mesh = cubes(kind, {{0, 0, 0}, {1, 1, 1}});
    const auto loose = loose_joints(mesh, clamp(mesh));
    ASSERT_EQ(loose.size(), 1u);
    EXPECT_EQ(loose[0].motions, 3);
    EXPECT_THAT(describe(loose[0], mesh), HasSubstr("(0.01, 0.01, 0.01)"));
  }
}

TEST(RigidParts, WhatSharesNothingIsLooseUnlessItIsHeld) {
  for (const Kind kind : kKinds) {
    const Mesh mesh = cubes(kind, {{0, 0, 0}, {3, 0, 0}});
    EXPECT_TRUE(loose_joints(mesh).empty());  // two components, which info counts
    auto held = clamp(mesh);
    ASSERT_EQ(loose_joints(mesh, held).size(), 1u);
    EXPECT_EQ(loose_joints(mesh, held)[0].motions, 6);
    EXPECT_TRUE(loose_joints(mesh, held)[0].shared.empty());
    for (NodeId n = 0; n < mesh.node_count(); ++n) {
      if (mesh.nodes(n, 0) < 0.035) continue;
      for (int axis = 0; axis < 3; ++axis) held.push_back({n, axis});
    }
    EXPECT_TRUE(loose_joints(mesh, held).empty());
  }
}

// Three cubes in a ring of edges are a triangle of hinges, which is rigid; pairs of them are not.
TEST(RigidParts, RingsOfHingesHoldEachOther) {
  for (const Kind kind : kKinds) {
    const Mesh ring = cubes(kind, {{0, 0, 0}, {1, 1, 0}, {1, 0, 1}});
    EXPECT_GT(rigid_parts(ring).size(), 1u);
    EXPECT_TRUE(loose_joints(ring, clamp(ring)).empty()) << static_cast<int>(kind);
    const Mesh chain = cubes(kind, {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}});
    EXPECT_EQ(loose_joints(chain, clamp(chain)).size(), 2u);
  }
}

TEST(RigidParts, TwoHingesOfOneAxisStayAHinge) {
  for (const Kind kind : kKinds) {  // a row of cubes along y on both sides of a common line
    const Mesh mesh = cubes(kind, {{0, 0, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}});
    const auto loose = loose_joints(mesh, clamp(mesh));
    ASSERT_EQ(loose.size(), 1u);
    EXPECT_EQ(loose[0].motions, 1);
  }
}

// Held nodes may take the freedom of a hinge.
TEST(RigidParts, RollersHoldAHinge) {
  const Mesh mesh = cubes(Kind::hexahedra, {{0, 0, 0}, {1, 0, 1}});
  auto held = clamp(mesh);
  for (NodeId n = 0; n < mesh.node_count(); ++n) {
    if (mesh.nodes(n, 0) > 0.015) held.push_back({n, 2});
  }
  EXPECT_TRUE(loose_joints(mesh, held).empty());
}

// Small parts far from the origin count as large ones do.
TEST(RigidParts, FarFromTheOrigin) {
  const Mesh mesh = cubes(Kind::tetrahedra, {{0, 0, 0}, {1, 0, 1}}, 5.0);
  EXPECT_EQ(loose_joints(mesh).size(), 1u);
}

}  // namespace
}  // namespace sinew::mesh
