#include "sinew/mesh/self_touch.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

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

INSTANTIATE_TEST_SUITE_P(Cells, SelfTouchTest,
                         ::testing::Values(Cells::tetrahedra, Cells::quadratic, Cells::hexahedra));

}  // namespace
}  // namespace sinew::mesh
