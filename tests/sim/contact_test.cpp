#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

#include "contact_robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::block_on_plane;
using sinew::testing::BlockOptions;
using sinew::testing::kBlockWeight;
using sinew::testing::kGravity;
using sinew::testing::mean_velocity;

TEST(Contact, BlockSticksBelowTheFrictionAngle) {
  const double critical = std::atan(0.5);
  for (const double share : {0.5, 0.95}) {
    Simulation simulation(block_on_plane({.angle = share * critical}).build());
    for (int k = 0; k < 500; ++k) simulation.step();
    const Vector3 before = simulation.fem_body(0).positions().colwise().mean();
    for (int k = 0; k < 500; ++k) simulation.step();
    const Vector3 after = simulation.fem_body(0).positions().colwise().mean();
    EXPECT_LT((after - before).norm(), 1e-9) << share;
    const ContactSum sum = simulation.contact_sum(0);
    EXPECT_NEAR(sum.normal_force, kBlockWeight * std::cos(share * critical), 1e-6 * kBlockWeight);
    EXPECT_NEAR(sum.force[0], -kBlockWeight * std::sin(share * critical), 1e-6 * kBlockWeight);
    EXPECT_LT(simulation.report().contact_residual, 1e-9);
  }
}

TEST(Contact, BlockSlidesAsCoulombSaysAboveIt) {
  for (const double angle : {0.55, 0.8}) {
    Simulation simulation(block_on_plane({.angle = angle}).build());
    // The settling of the rubber dies away first.
    for (int k = 0; k < 600; ++k) simulation.step();
    const double before = mean_velocity(simulation)[0];
    for (int k = 0; k < 400; ++k) simulation.step();
    const double acceleration = (mean_velocity(simulation)[0] - before) / 0.4;
    const double expected = kGravity * (std::sin(angle) - 0.5 * std::cos(angle));
    EXPECT_NEAR(acceleration, expected, 1e-3 * expected) << angle;
    const ContactSum sum = simulation.contact_sum(0);
    EXPECT_EQ(sum.sticking, 0);
    EXPECT_NEAR(sum.friction_force, 0.5 * sum.normal_force, 1e-9 * kBlockWeight);
  }
}

}  // namespace
}  // namespace sinew::sim
