// Cable guides: tubes of a given radius along a conduit.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "sinew/builder/cable_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {
namespace {

Points rows(std::initializer_list<Vector3> points) {
  Points result(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::Index i = 0;
  for (const Vector3& point : points) result.row(i++) = point.transpose();
  return result;
}

/// A clamped block, 100 x 40 x 40 mm, with one cable.
builder::ModelBuilder block_with(builder::CableSettings cable, int cells_across) {
  builder::ModelBuilder builder;
  fem::FemBodySettings body;
  body.name = "block";
  const auto mesh = std::make_shared<const mesh::Mesh>(mesh::block(
      {.size = {0.1, 0.04, 0.04}, .cells = {5 * cells_across / 2, cells_across, cells_across}}));
  body.mesh = mesh;
  body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  builder.add_body<fem::FemBodyModel>(std::move(body));
  cable.name = "rope";
  builder.add_cable(cable);
  return builder;
}

TEST(Guides, SpacingSetsTheGuidesThatOneWouldWrite) {
  builder::CableSettings written, set;
  written.points = rows({{0.0, 0.02, 0.03},
                         {0.025, 0.02, 0.03},
                         {0.05, 0.02, 0.03},
                         {0.07, 0.02, 0.03},
                         {0.09, 0.02, 0.03}});
  set.points = rows({{0.0, 0.02, 0.03}, {0.05, 0.02, 0.03}, {0.09, 0.02, 0.03}});
  set.guide_spacing = 0.025;
  const auto same = block_with(set, 4).build();
  EXPECT_EQ(same->fingerprint(), block_with(written, 4).build()->fingerprint());
  set.guide_radius = 0.005;
  EXPECT_NE(same->fingerprint(), block_with(set, 4).build()->fingerprint());
}

/// Displacement of the end of a cable that pulls a point of the block sideways with 1 N, m.
double pulled(double radius, int cells_across) {
  builder::CableSettings cable;
  cable.points = rows({{0.07, 0.02, 0.2}, {0.07, 0.02, 0.02}});
  cable.guide_radius = radius;
  Simulation simulation(block_with(cable, cells_across).build());
  simulation.command(0, {model::CommandKind::effort, model::Signal::constant(1.0)});
  simulation.solve_static();
  return simulation.actuator(0).motion;
}

TEST(Guides, ATubeDentsLessOnAFineMeshThanABarePoint) {
  const double bare = pulled(0.0, 12) / pulled(0.0, 6);
  const double tube = pulled(0.01, 12) / pulled(0.01, 6);
  EXPECT_GT(bare, 1.05);
  EXPECT_LT(std::abs(tube - 1.0), 0.4 * (bare - 1.0));
}

TEST(Guides, NegativeRadiusOrSpacingIsAnError) {
  builder::CableSettings cable;
  cable.points = rows({{0.0, 0.02, 0.03}, {0.09, 0.02, 0.03}});
  for (double builder::CableSettings::*key :
       {&builder::CableSettings::guide_radius, &builder::CableSettings::guide_spacing}) {
    builder::CableSettings bad = cable;
    bad.*key = -0.001;
    try {
      block_with(bad, 4);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::out_of_range);
      EXPECT_NE(std::string(error.what()).find("-0.001 m"), std::string::npos) << error.what();
    }
  }
  cable.guide_spacing = 1e-9;
  EXPECT_THROW(block_with(cable, 4), Error);
}

}  // namespace
}  // namespace sinew::sim
