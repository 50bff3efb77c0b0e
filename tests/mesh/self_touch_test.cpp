#include "sinew/mesh/self_touch.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/shapes.hpp"

namespace sinew::mesh {
namespace {

// A bar along x bent into an arc of `turn` radians; at a full turn it closes on itself.
Points bent(const Points& rest, double length, double turn) {
  Points moved = rest;
  const double radius = length / turn;
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const double angle = rest(i, 0) / radius, r = radius - rest(i, 2);
    moved.row(i) << r * std::sin(angle), rest(i, 1), radius - r * std::cos(angle);
  }
  return moved;
}

class SelfTouchTest : public ::testing::TestWithParam<Cells> {};

TEST_P(SelfTouchTest, BarThatClosesOnItselfIsSeen) {
  const Mesh mesh = block({.size = {0.2, 0.01, 0.01}, .cells = {40, 2, 2}}, GetParam());
  const SelfTouch touch(mesh);
  EXPECT_FALSE(touch.find(mesh.nodes));
  constexpr double kTurn = 2.0 * std::numbers::pi;
  EXPECT_FALSE(touch.find(bent(mesh.nodes, 0.2, 0.98 * kTurn)));
  // Slightly skewed, so no node lies on a face.
  Points closed = bent(mesh.nodes, 0.2, 1.013 * kTurn);
  for (Eigen::Index i = 0; i < closed.rows(); ++i) closed(i, 1) += 1e-2 * mesh.nodes(i, 0);
  const auto found = touch.find(closed);
  ASSERT_TRUE(found);
  // One end penetrates the other.
  const double x = mesh.nodes(found->node, 0);
  EXPECT_TRUE(x < 0.02 || x > 0.18) << x;
  EXPECT_TRUE(touch.find(closed, 0.1));
  EXPECT_FALSE(touch.find(closed, 0.25)) << "longer than the bar";
}

TEST_P(SelfTouchTest, NodesThatMeetNobodyAreFree) {
  const Mesh mesh = block({.size = {0.2, 0.01, 0.01}, .cells = {20, 1, 1}}, GetParam());
  const SelfTouch touch(mesh);
  Points twisted = mesh.nodes;
  for (Eigen::Index i = 0; i < twisted.rows(); ++i) {
    const double angle = 4.0 * mesh.nodes(i, 0) / 0.2;
    const double y = mesh.nodes(i, 1) - 0.005, z = mesh.nodes(i, 2) - 0.005;
    twisted(i, 1) = y * std::cos(angle) - z * std::sin(angle);
    twisted(i, 2) = y * std::sin(angle) + z * std::cos(angle);
  }
  EXPECT_FALSE(touch.find(twisted));
}

/// Two quadratic tetrahedra that do not touch at rest: a large one, and a small one below its
/// highest corner 4, which the tests move.
Mesh two_tetrahedra() {
  Mesh mesh;
  mesh.nodes.resize(8, 3);
  mesh.nodes << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1,  //
      5, 5, 5, 5, 5.2, 4.8, 5.2, 5, 4.8, 5, 5, 4.8;
  mesh.tetrahedra = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  return with_middle_nodes(mesh);
}

/// Positions in which the face z = 0 of the large element bulges by `bulge` along -z at its centre,
/// and the small one is at `point`.
Points bulged(const Mesh& mesh, double bulge, const Vector3& point) {
  Points moved = mesh.nodes;
  // A third of the sum over the middle nodes of 4 L_i L_j is 4/3 at the centre of the face.
  for (const auto& [a, b] : {std::pair(0, 1), {1, 2}, {2, 0}}) {
    moved(middle_node(mesh.quadratic[0], a, b), 2) -= 0.75 * bulge;
  }
  const Eigen::RowVector3d to = point.transpose() - mesh.nodes.row(4);
  for (NodeId node = 0; node < moved.rows(); ++node) {
    if (mesh.nodes(node, 0) > 2.0) moved.row(node) += to;
  }
  return moved;
}

// The straight tetrahedron between the corners is neither all of a curved element nor within it.
TEST(SelfTouchOfCurvedElements, GoesByTheCurvedFace) {
  const Mesh mesh = two_tetrahedra();
  const SelfTouch touch(mesh);
  const double third = 1.0 / 3.0;
  const Vector3 above(third, third, 0.05), below(third, third, -0.05);
  EXPECT_TRUE(touch.find(bulged(mesh, 0.0, above)));
  EXPECT_FALSE(touch.find(bulged(mesh, -0.2, above))) << "in the straight one, in the dent";
  EXPECT_FALSE(touch.find(bulged(mesh, 0.0, below)));
  EXPECT_TRUE(touch.find(bulged(mesh, 0.2, below))) << "in the bulge";
}

// Contact replaces the face by four flat triangles: three quarters of the bulge at its centre.
TEST(SelfTouchOfCurvedElements, NodesOnTheFlatTrianglesOfContactAreOutside) {
  const Mesh mesh = two_tetrahedra();
  const SelfTouch touch(mesh);
  const double third = 1.0 / 3.0;
  EXPECT_FALSE(touch.find(bulged(mesh, 0.2, Vector3(third, third, -0.16))));
  EXPECT_TRUE(touch.find(bulged(mesh, 0.2, Vector3(third, third, -0.14))));
}

TEST(SelfTouchOfCurvedElements, CoordinatesAreFoundFromThePoint) {
  const Mesh mesh = two_tetrahedra();
  const Points moved = bulged(mesh, 0.3, mesh.nodes.row(4).transpose());
  Eigen::Matrix<double, 10, 3> nodes;
  for (Eigen::Index a = 0; a < 10; ++a) {
    nodes.row(a) = moved.row(mesh.quadratic[0][static_cast<std::size_t>(a)]);
  }
  for (const std::array<double, 4>& at :
       {std::array{0.1, 0.2, 0.3, 0.4}, {0.7, 0.1, 0.1, 0.1}, {0.32, 0.33, 0.34, 0.01}}) {
    Vector3 point = Vector3::Zero();
    const auto shapes = quadratic_shapes(at);
    for (Eigen::Index a = 0; a < 10; ++a) {
      point += shapes[static_cast<std::size_t>(a)] * nodes.row(a).transpose();
    }
    const auto found = quadratic_coordinates(point, nodes);
    ASSERT_TRUE(found);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR((*found)[k], at[k], 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Cells, SelfTouchTest,
                         ::testing::Values(Cells::tetrahedra, Cells::quadratic, Cells::hexahedra));

}  // namespace
}  // namespace sinew::mesh
