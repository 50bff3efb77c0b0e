#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/sim/actuator.hpp"
#include "sinew/sim/effector_settings.hpp"
#include "sinew/sim/force_settings.hpp"
#include "sinew/sim/joint_settings.hpp"
#include "sinew/sim/load_settings.hpp"
#include "sinew/sim/model_builder.hpp"
#include "sinew/sim/simulation.hpp"

#include "robots.hpp"

namespace sinew::sim {
namespace {

constexpr double kHalfSpan = 0.05;  // m

// A part of the arch along x.
fem::FemBodySettings arch_part(const char* name, double from, double to) {
  fem::FemBodySettings body;
  body.name = name;
  mesh::Mesh made =
      mesh::block({.corner = {from, 0.0, 0.0},
                   .size = {to - from, 0.004, 0.002},
                   .cells = {static_cast<int>(std::lround((to - from) / 0.0025)), 1, 2}},
                  mesh::Cells::hexahedra);
  for (Eigen::Index i = 0; i < made.nodes.rows(); ++i) {
    const double x = made.nodes(i, 0) / kHalfSpan;
    made.nodes(i, 2) += 0.008 * 0.5 * (1.0 + std::cos(3.14159265358979 * x));
  }
  const auto mesh = std::make_shared<const mesh::Mesh>(std::move(made));
  body.mesh = mesh;
  fem::Region region;
  region.hyperelastic = material::neo_hookean(4e4);
  region.hyperelastic->bulk_modulus = 1e5;
  region.density = 1000.0;
  body.elements.regions = {region};
  for (NodeId node = 0; node < static_cast<NodeId>(mesh->nodes.rows()); ++node) {
    const double x = mesh->nodes(node, 0);
    if (std::abs(x) > kHalfSpan - 1e-9) body.elements.fixed_nodes.push_back(node);
    // Its crown stays in the middle and one side in its plane: swaying would be branches of their
    // own.
    if (std::abs(x) < 1e-9) body.elements.held_axes.push_back({node, 0});
    if (mesh->nodes(node, 1) == 0.0) body.elements.held_axes.push_back({node, 1});
  }
  return body;
}

/// A shallow arch, both ends clamped, pressed down at its crown by a force actuator or by a load of
/// the same place: it snaps through. @param cut into three bodies that are welded together again:
/// welds alone hold the one in the middle.
std::shared_ptr<const Model> arch(bool by_load, bool cut = false) {
  ModelBuilder builder;
  int middle = 0;
  if (cut) {
    const double seam = 0.015;
    const int left = builder.add_fem_body(arch_part("left", -kHalfSpan, -seam));
    middle = builder.add_fem_body(arch_part("middle", -seam, seam));
    const int right = builder.add_fem_body(arch_part("right", seam, kHalfSpan));
    const auto& seams = builder.added_body(middle).mesh().node_sets;
    builder.add_weld(
        {.name = "first", .first = middle, .second = left, .nodes = seams.at("x_min")});
    builder.add_weld(
        {.name = "second", .first = middle, .second = right, .nodes = seams.at("x_max")});
  } else {
    builder.add_fem_body(arch_part("arch", -kHalfSpan, kHalfSpan));
  }
  const Vector3 crown(0.0, 0.002, 0.009);
  if (by_load) {
    builder.add_load(
        {.name = "press", .body = middle, .load = PointLoadSettings{crown, {0.0, 0.0, -0.02}}});
  } else {
    ForceSettings force;
    force.name = "press";
    force.body = middle;
    force.point = crown;
    force.direction = {0.0, 0.0, -1.0};
    builder.add_force(force);
  }
  EffectorSettings top;
  top.name = "crown";
  top.body = middle;
  top.points = crown.transpose();
  builder.add_effector(top);
  return builder.build();
}

// The path of the load is that which a commanded motion passes point by point.
TEST(Path, SnapThroughAgreesWithControlByMotion) {
  Simulation loaded(arch(true)), moved(arch(false));
  std::vector<double> depth, share;
  const double top = loaded.effector_value(0).z();
  const auto path = loaded.follow_path({.first_step = 2e-3, .largest_step = 5e-3}, [&] {
    depth.push_back(top - loaded.effector_value(0).z());
  });
  ASSERT_EQ(path.size(), depth.size());
  ASSERT_GT(path.size(), 10u);
  EXPECT_GE(path.back().share, 1.0);
  double largest = 0.0, least = 1.0;
  bool past_peak = false;
  for (std::size_t k = 1; k < path.size(); ++k) {
    past_peak = past_peak || path[k].share < path[k - 1].share;
    if (!past_peak) largest = std::max(largest, path[k].share);
    if (past_peak) least = std::min(least, path[k].share);
    if (k % 4 != 0 && k + 1 != path.size()) continue;
    moved.command(0, sinew::testing::pull(depth[k]));
    moved.solve_static();
    EXPECT_NEAR(moved.actuator(0).effort, 0.02 * path[k].share, 1e-6 * 0.02) << k;
  }
  EXPECT_TRUE(past_peak);
  EXPECT_LT(least, 0.8 * largest);
  EXPECT_TRUE(std::ranges::any_of(path, [](const auto& p) { return p.negative_pivots == 1; }));
  EXPECT_EQ(path.back().negative_pivots, 0);
  EXPECT_EQ(path.front().negative_pivots, 0);
}

// Joints are held along the path, and the springs that hold a loose body are no part of it: the
// whole arch passes the same points.
TEST(Path, OfAnArchThatIsCutAndWelded) {
  Simulation cut(arch(true, true)), whole(arch(false));
  std::vector<double> depth;
  const double top = cut.effector_value(0).z();
  const auto path = cut.follow_path({.first_step = 5e-3, .largest_step = 1.5e-2},
                                    [&] { depth.push_back(top - cut.effector_value(0).z()); });
  ASSERT_GT(path.size(), 10u);
  EXPECT_GE(path.back().share, 1.0);
  int turned = 0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    turned += path[k].share < path[k - 1].share ? 1 : 0;
    whole.command(0, sinew::testing::pull(depth[k]));
    whole.solve_static();
    EXPECT_NEAR(whole.actuator(0).effort, 0.02 * path[k].share, 1e-6 * 0.02) << k;
  }
  EXPECT_GT(turned, 3);
  EXPECT_TRUE(std::ranges::any_of(path, [](const auto& p) { return p.negative_pivots == 1; }));
  EXPECT_EQ(path.front().negative_pivots, 0);
  EXPECT_EQ(path.back().negative_pivots, 0);
}

// From the end of the path the load itself is a small step away.
TEST(Path, EndsNextToTheEquilibriumOfTheFullLoad) {
  Simulation loaded(arch(true));
  loaded.follow_path({.first_step = 2e-3, .largest_step = 1e-2});
  const Vector3 end = loaded.effector_value(0);
  const auto report = loaded.solve_static();
  EXPECT_EQ(report.status, NewtonStatus::converged);
  EXPECT_LT((loaded.effector_value(0) - end).norm(), 2e-3);
}

TEST(Path, EffortsGrowAlongIt) {
  Simulation pressed(arch(false));
  pressed.command(0, sinew::testing::tension(0.002));
  const auto path = pressed.follow_path({.first_step = 1e-3, .largest_step = 1e-3});
  EXPECT_NEAR(pressed.actuator(0).effort, 0.002 * path.back().share, 1e-15);
  EXPECT_LT(pressed.effector_value(0).z(), 0.009 - 1e-4);
}

TEST(Path, ActuatorsToldAMotionAreRefused) {
  Simulation pressed(arch(false));
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
