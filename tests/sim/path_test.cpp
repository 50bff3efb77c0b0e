#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/sim/actuator.hpp"
#include "sinew/sim/simulation.hpp"

#include "arches.hpp"
#include "robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::arch;

// Path following gives the same points as a commanded motion.
TEST(Path, SnapThroughAgreesWithControlByMotion) {
  Simulation loaded(arch({})), moved(arch({.by_load = false}));
  std::vector<double> depth, load_fraction;
  const double top = loaded.effector_value(0).z();
  const auto path = loaded.follow_path({.first_step = 2e-3, .largest_step = 5e-3}, [&] {
    depth.push_back(top - loaded.effector_value(0).z());
  });
  ASSERT_EQ(path.size(), depth.size());
  ASSERT_GT(path.size(), 10u);
  EXPECT_GE(path.back().load_fraction, 1.0);
  double largest = 0.0, least = 1.0;
  bool past_peak = false;
  for (std::size_t k = 1; k < path.size(); ++k) {
    past_peak = past_peak || path[k].load_fraction < path[k - 1].load_fraction;
    if (!past_peak) largest = std::max(largest, path[k].load_fraction);
    if (past_peak) least = std::min(least, path[k].load_fraction);
    if (k % 4 != 0 && k + 1 != path.size()) continue;
    moved.command(0, sinew::testing::pull(depth[k]));
    moved.solve_static();
    EXPECT_NEAR(moved.actuator(0).effort, 0.02 * path[k].load_fraction, 1e-6 * 0.02) << k;
  }
  EXPECT_TRUE(past_peak);
  EXPECT_LT(least, 0.8 * largest);
  EXPECT_TRUE(std::ranges::any_of(path, [](const auto& p) { return p.negative_pivots == 1; }));
  EXPECT_EQ(path.back().negative_pivots, 0);
  EXPECT_EQ(path.front().negative_pivots, 0);
}

// Joints hold along the path, and the springs that stabilise a loose body do not affect it: the
// uncut arch passes through the same points.
TEST(Path, OfAnArchThatIsCutAndWelded) {
  Simulation cut(arch({.cut = true})), whole(arch({.by_load = false}));
  std::vector<double> depth;
  const double top = cut.effector_value(0).z();
  const auto path = cut.follow_path({.first_step = 5e-3, .largest_step = 1.5e-2},
                                    [&] { depth.push_back(top - cut.effector_value(0).z()); });
  ASSERT_GT(path.size(), 10u);
  EXPECT_GE(path.back().load_fraction, 1.0);
  int turned = 0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    turned += path[k].load_fraction < path[k - 1].load_fraction ? 1 : 0;
    whole.command(0, sinew::testing::pull(depth[k]));
    whole.solve_static();
    EXPECT_NEAR(whole.actuator(0).effort, 0.02 * path[k].load_fraction, 1e-6 * 0.02) << k;
  }
  EXPECT_GT(turned, 3);
  EXPECT_TRUE(std::ranges::any_of(path, [](const auto& p) { return p.negative_pivots == 1; }));
  EXPECT_EQ(path.front().negative_pivots, 0);
  EXPECT_EQ(path.back().negative_pivots, 0);
}

// The equilibrium at the full load is close to the end of the path.
TEST(Path, EndsNextToTheEquilibriumOfTheFullLoad) {
  Simulation loaded(arch({}));
  loaded.follow_path({.first_step = 2e-3, .largest_step = 1e-2});
  const Vector3 end = loaded.effector_value(0);
  const auto report = loaded.solve_static();
  EXPECT_EQ(report.status, NewtonStatus::converged);
  EXPECT_LT((loaded.effector_value(0) - end).norm(), 2e-3);
}

TEST(Path, EffortsGrowAlongIt) {
  Simulation pressed(arch({.by_load = false}));
  pressed.command(0, sinew::testing::tension(0.002));
  const auto path = pressed.follow_path({.first_step = 1e-3, .largest_step = 1e-3});
  EXPECT_NEAR(pressed.actuator(0).effort, 0.002 * path.back().load_fraction, 1e-15);
  EXPECT_LT(pressed.effector_value(0).z(), 0.009 - 1e-4);
}

TEST(Path, ActuatorsToldAMotionAreRefused) {
  Simulation pressed(arch({.by_load = false}));
  pressed.command(0, sinew::testing::pull(0.002));
  try {
    pressed.follow_path({});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_argument);
  }
}

}  // namespace
}  // namespace sinew::sim
