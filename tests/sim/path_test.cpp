#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
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
  const auto path = loaded
                        .follow_path({.first_step = 2e-3, .largest_step = 5e-3},
                                     [&] { depth.push_back(top - loaded.effector_value(0).z()); })
                        .points;
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
                                    [&] { depth.push_back(top - cut.effector_value(0).z()); })
                        .points;
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

// Unstable directions of the symmetric equilibrium at a load, from a search of its own.
int unstable_directions(const std::shared_ptr<const model::Model>& model, double load) {
  Simulation simulation(model);
  simulation.set_load(0, model::Signal::constant(load));
  return simulation.solve_static({.stability = statics::StabilityChoice::any}).negative_pivots;
}

// An arch that may sway loses its stability before its limit point. The path finds the bifurcation
// and stays symmetric: it passes the points of the arch whose crown is guided.
TEST(Path, AnArchThatSwaysBifurcatesBeforeItsLimitPoint) {
  for (const double first_step : {1e-4, 0.01, 0.2}) {
    const auto model = arch({.sways = true});
    Simulation loaded(model), guided(arch({.by_load = false}));
    loaded.set_load(0, model::Signal::constant(1.5));
    const double top = loaded.effector_value(0).z();
    std::vector<Vector3> crown;
    const statics::Path path =
        loaded.follow_path({.first_step = first_step, .largest_step = 0.02},
                           [&] { crown.push_back(loaded.effector_value(0)); });
    EXPECT_EQ(path.end, statics::PathEnd::full_load);
    std::vector<statics::PathEvent> events;
    double before = 0.0;
    for (std::size_t k = 0; k < path.points.size(); ++k) {
      const statics::PathPoint& point = path.points[k];
      EXPECT_LE(std::abs(point.load_fraction - before), 0.1) << k;
      EXPECT_LE(point.load_fraction, 1.1) << k;
      if (point.event != statics::PathEvent::none) events.push_back(point.event);
      if (point.event == statics::PathEvent::bifurcation && events.size() == 1) {
        EXPECT_EQ(unstable_directions(model, 1.5 * 0.99 * point.load_fraction), 0);
        EXPECT_EQ(unstable_directions(model, 1.5 * 1.01 * point.load_fraction), 1);
      }
      before = point.load_fraction;
      EXPECT_LT(std::abs(crown[k].x()), 1e-6) << k;
      if (k % 4 != 0) continue;
      guided.command(0, sinew::testing::pull(top - crown[k].z()));
      guided.solve_static({.stability = statics::StabilityChoice::any});
      EXPECT_NEAR(guided.actuator(0).effort, 0.03 * point.load_fraction, 1e-6 * 0.03) << k;
    }
    ASSERT_GE(events.size(), 2u);
    EXPECT_EQ(events[0], statics::PathEvent::bifurcation);
    EXPECT_EQ(events[1], statics::PathEvent::limit_point);
    double largest = 0.0;
    for (const statics::PathPoint& point : path.points) {
      if (point.event == statics::PathEvent::limit_point) break;
      largest = std::max(largest, point.load_fraction);
    }
    ASSERT_TRUE(path.limit_load.has_value());
    EXPECT_GE(*path.limit_load, largest);
    EXPECT_LT(*path.limit_load, 1.02 * largest);
  }
}

// A path that ends early returns its points, and where it ended.
TEST(Path, EndsEarlyWithWhatItFound) {
  Simulation loaded(arch({}));
  const statics::Path path =
      loaded.follow_path({.first_step = 2e-3, .largest_step = 5e-3, .max_points = 4});
  EXPECT_EQ(path.end, statics::PathEnd::max_points);
  ASSERT_EQ(path.points.size(), 4u);
  EXPECT_NE(path.reason.find("max_points"), std::string::npos);
  EXPECT_FALSE(path.limit_load.has_value());
}

// The equilibrium at the full load is close to the end of the path.
TEST(Path, EndsNextToTheEquilibriumOfTheFullLoad) {
  Simulation loaded(arch({}));
  loaded.follow_path({.first_step = 2e-3, .largest_step = 1e-2});
  const Vector3 end = loaded.effector_value(0);
  const auto report = loaded.solve_static();
  EXPECT_EQ(report.status, run::NewtonStatus::converged);
  EXPECT_LT((loaded.effector_value(0) - end).norm(), 2e-3);
}

TEST(Path, EffortsGrowAlongIt) {
  Simulation pressed(arch({.by_load = false}));
  pressed.command(0, sinew::testing::tension(0.002));
  const auto path = pressed.follow_path({.first_step = 1e-3, .largest_step = 1e-3}).points;
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
