#include "sinew/contact/contact_zones.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/contact/row_numbering.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/step_report.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

#include "contact_robots.hpp"
#include "support/allocation_guard.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::block_on_plane;
using sinew::testing::BlockOptions;
using sinew::testing::kBlockWeight;

constexpr double kZone = 0.02;

BlockOptions options(double aggregate, double friction, double angle = 0.0) {
  return {.angle = angle, .friction = friction, .cells = {6, 6, 3}, .aggregate = aggregate};
}

std::vector<double> normal_forces(const Simulation& simulation) {
  std::vector<double> forces;
  for (const contact::ContactPoint& point : simulation.contacts().points(0)) {
    forces.push_back(point.normal_force);
  }
  return forces;
}

// Without friction, zones differ from points only in how forces are distributed. Zones leave
// overlaps of 1 % of their indentation, and a point is stiffer than its zone.
TEST(ContactZones, ForcesOfABlockAtRestAreThoseOfItsPoints) {
  Simulation points(block_on_plane(options(0.0, 0.0)).build());
  Simulation zones(block_on_plane(options(kZone, 0.0)).build());
  for (int k = 0; k < 200; ++k) {
    points.step();
    zones.step();
  }
  const auto mine = normal_forces(zones), theirs = normal_forces(points);
  double sum = 0.0;
  for (std::size_t k = 0; k < mine.size(); ++k) {
    sum += mine[k];
    const double mean = kBlockWeight / static_cast<double>(mine.size());
    EXPECT_NEAR(mine[k], theirs[k], 0.1 * (theirs[k] + mean)) << k;
  }
  EXPECT_NEAR(sum, kBlockWeight, 1e-6 * kBlockWeight);
  EXPECT_LT(zones.world().problem().contacts.size(), points.world().problem().contacts.size() / 2);
}

// The force of each point lies in its own cone, and the block slides at g (sin - mu cos).
TEST(ContactZones, ABlockSlidesAsCoulombSays) {
  const double angle = 0.5, friction = 0.3;
  Simulation simulation(block_on_plane(options(kZone, friction, angle)).build());
  for (int k = 0; k < 100; ++k) simulation.step();
  const double before = simulation.body(0).velocities().col(0).mean();
  for (int k = 0; k < 100; ++k) simulation.step();
  const double gained = simulation.body(0).velocities().col(0).mean() - before;
  const double expected =
      sinew::testing::kGravity * (std::sin(angle) - friction * std::cos(angle)) * 0.1;
  EXPECT_NEAR(gained, expected, 5e-3 * expected);
  for (const contact::ContactPoint& point : simulation.contacts().points(0)) {
    EXPECT_LE(point.friction_force.norm(), friction * point.normal_force + 1e-12);
  }
}

// delta = delta_free + W lambda of a zone is the mean over its points.
TEST(ContactZones, ComplianceIsThatOfTheSpreadForces) {
  Simulation simulation(block_on_plane(options(kZone, 0.5, 0.2)).build());
  for (int k = 0; k < 20; ++k) simulation.step();
  world::World& world = simulation.world();
  const MatrixX w = world.problem().compliance;
  const auto rows = static_cast<int>(w.rows());
  std::vector<double> unit(simulation.efforts().size(), 0.0);
  VectorX rest, loaded;
  world.bodies().imbalance(unit, rest);
  for (const int row : {0, 1, rows - 1}) {
    world.numbering().spread(row, 1.0, unit);
    world.bodies().imbalance(unit, loaded);
    world.numbering().spread(row, 0.0, unit);
    VectorX motion;
    world.bodies().solve(loaded - rest, motion);
    // H times the motion, row by row: the forces of a unit effort times the motion.
    for (const int other : {0, 2, rows - 2}) {
      world.numbering().spread(other, 1.0, unit);
      world.bodies().imbalance(unit, loaded);
      world.numbering().spread(other, 0.0, unit);
      EXPECT_NEAR((loaded - rest).dot(motion), w(other, row), 1e-10 * w.norm());
    }
  }
}

TEST(ContactZones, StepsDoNotAllocate) {
  if (!sinew::testing::counts_allocations()) GTEST_SKIP();
  Simulation simulation(block_on_plane(options(kZone, 0.3, 0.5)).build());
  for (int k = 0; k < 100; ++k) simulation.step();
  const long before = sinew::testing::allocations();
  for (int k = 0; k < 50; ++k) simulation.step();
  EXPECT_EQ(sinew::testing::allocations(), before);
}

}  // namespace
}  // namespace sinew::sim
