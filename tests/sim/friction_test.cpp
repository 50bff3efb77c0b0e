#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/cable_settings.hpp"
#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::beam;
using sinew::testing::BeamOptions;
using sinew::testing::pull;
using sinew::testing::tension;

constexpr double kFriction = 0.3;

/// A block with a cable that runs straight in, along a quarter circle of radius 40 mm, and straight
/// out.
std::shared_ptr<const model::Model> bollard(int points_on_arc) {
  model::StepSettings step;
  step.tolerance = 1e-11;  // friction laws are checked to the last digits
  step.method = model::Method::newton;
  builder::ModelBuilder builder(step);
  fem::FemBodySettings body;
  body.name = "block";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.size = {0.1, 0.1, 0.02}, .cells = {6, 6, 2}}));
  body.mesh = mesh;
  body.elements.regions = {{{1e6, 0.3}, material::Law::corotational, 1000.0, {}}};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::CableSettings cable;
  cable.name = "rope";
  cable.friction = kFriction;
  cable.points.resize(points_on_arc + 2, 3);
  cable.points.row(0) << 0.0, 0.06, 0.01;
  for (int i = 0; i < points_on_arc; ++i) {
    const double angle = sinew::testing::kRightAngle * (i + 0.5) / points_on_arc;
    cable.points.row(i + 1) << 0.02 + 0.04 * std::sin(angle), 0.02 + 0.04 * std::cos(angle), 0.01;
  }
  cable.points.row(points_on_arc + 1) << 0.06, 0.005, 0.01;
  builder.add_cable(cable);
  return builder.build();
}

std::vector<double> tensions(const Simulation& simulation, int actuator = 0) {
  return simulation.model().cable(actuator)->tensions(simulation.efforts());
}

// Every ratio of neighbouring tensions is within Coulomb's limits, and at the limit of `sign`
// unless that is 0.
void expect_friction(const Simulation& simulation, double sign) {
  const auto& model = simulation.model();
  const auto& configuration = simulation.configuration();
  const auto own = tensions(simulation);
  for (int via = 0; via < model.cable(0)->via_count(); ++via) {
    const auto k = static_cast<std::size_t>(via);
    const double most = std::exp(kFriction * model.cable(0)->turn(configuration, via));
    const double ratio = own[k] / own[k + 1];
    EXPECT_LE(ratio, most * (1.0 + 1e-8)) << via;
    EXPECT_GE(ratio, (1.0 - 1e-8) / most) << via;
    if (sign != 0.0) {
      EXPECT_NEAR(ratio, std::pow(most, sign), 1e-7) << via;
    }
  }
}

TEST(Friction, RopeOverABollardFollowsEuler) {
  for (const int points : {1, 4, 16}) {
    const auto model = bollard(points);
    Simulation simulation(model);
    simulation.command(0, tension(3.0));
    simulation.step();
    const auto own = tensions(simulation);
    const double wrap = model->cable(0)->wrap(simulation.configuration());
    EXPECT_GT(wrap, 1.0);
    EXPECT_NEAR(own.front() / own.back(), std::exp(kFriction * wrap), 1e-7);
    expect_friction(simulation, 1.0);
  }
}

TEST(Friction, ReleasedRopeSticksBeforeItSlides) {
  const auto model = bollard(8);
  Simulation simulation(model);
  simulation.command(0, tension(3.0));
  simulation.step();
  const double behind = tensions(simulation).back();
  simulation.command(0, tension(2.7));
  simulation.step();
  // Behind the points that slide back, a release by a tenth acts only through the motion of the
  // block.
  EXPECT_NEAR(tensions(simulation).back(), behind, 5e-3 * behind);
  EXPECT_NEAR(tensions(simulation).front(), 2.7, 1e-9);
  expect_friction(simulation, 0.0);
  simulation.command(0, tension(0.5));
  simulation.step();
  expect_friction(simulation, -1.0);
  EXPECT_GT(tensions(simulation).back(), 0.5);
}

TEST(Friction, ForcesOfRowsAreThoseOfTheSegments) {
  const auto model = bollard(4);
  Simulation simulation(model);
  simulation.command(0, tension(3.0));
  simulation.step();
  const auto& body = *mechanics::as<const fem::HasMaterial>(simulation.body(0));
  Points forces = Points::Zero(body.positions().rows(), 3);
  body.add_row_forces(simulation.efforts(), forces);
  // The resultant is that of the straight ends, without the one at the world's pull point.
  const auto own = tensions(simulation);
  const Points points = model->cable(0)->points(simulation.configuration());
  const Vector3 first = (points.row(1) - points.row(0)).transpose().normalized();
  // Forces on fixed nodes are not included; the cable stays away from these, so the sum is
  // complete.
  const Vector3 sum = forces.colwise().sum().transpose();
  const Vector3 expected = -own.front() * first;
  EXPECT_LT((sum - expected).norm(), 1e-6 * own.front());
}

// With friction, the same length requires more tension.
TEST(Friction, BentBeamLosesTensionAlongItsCable) {
  model::StepSettings step;
  step.tolerance = 1e-11;  // friction laws are checked to the last digits
  step.method = model::Method::newton;
  Simulation smooth(beam({.step = step})), rough(beam({.step = step, .friction = kFriction}));
  for (Simulation* simulation : {&smooth, &rough}) {
    simulation->command(0, pull(0.004));
    for (int k = 1; k < 4; ++k) simulation->command(k, tension(0.0));
    simulation->step();
    EXPECT_EQ(simulation->report().newton, run::NewtonStatus::converged);
    EXPECT_NEAR(simulation->actuator(0).motion, 0.004, 1e-10);
  }
  expect_friction(rough, 1.0);
  EXPECT_GT(rough.actuator(0).effort, smooth.actuator(0).effort);
}

TEST(Friction, CyclesDissipate) {
  model::StepSettings step;
  step.tolerance = 1e-11;  // friction laws are checked to the last digits
  step.method = model::Method::newton;
  const auto work_of_cycle = [&](double friction) {
    Simulation simulation(beam({.step = step, .cables = 1, .friction = friction}));
    double work = 0.0;
    for (const bool second : {false, true}) {
      for (int k = 0; k < 40; ++k) {
        const double phase = k / 40.0;
        const double share = phase < 0.5 ? 2.0 * phase : 2.0 - 2.0 * phase;
        const double before = simulation.actuator(0).effort;
        const double from = simulation.actuator(0).motion;
        simulation.command(0, tension(0.2 + 2.0 * share));
        simulation.step();
        // Trapezoidal rule: end-of-step efforts alone overestimate the work at first order.
        const double mean = 0.5 * (before + simulation.actuator(0).effort);
        if (second) work += mean * (simulation.actuator(0).motion - from);
      }
    }
    return work;
  };
  const double smooth = work_of_cycle(0.0), rough = work_of_cycle(kFriction);
  EXPECT_GT(rough, 0.0);
  EXPECT_LT(std::abs(smooth), 0.02 * rough);
}

TEST(Friction, StateRestoresWithItsFriction) {
  const auto model = bollard(8);
  Simulation simulation(model);
  simulation.command(0, tension(3.0));
  simulation.step();
  run::State state = simulation.state();
  simulation.command(0, tension(2.0));
  simulation.step();
  Simulation other(model);
  other.restore(state);
  other.command(0, tension(2.0));
  other.step();
  const Points gap = other.body(0).positions() - simulation.body(0).positions();
  EXPECT_LT(gap.cwiseAbs().maxCoeff(), 1e-13);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(tensions(other)[k], tensions(simulation)[k], 1e-9) << k;
  }
}

TEST(Friction, NegativeCoefficientIsAnError) {
  BeamOptions options;
  options.friction = -0.1;
  try {
    beam(options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::out_of_range);
    EXPECT_FALSE(error.remedy().empty());
  }
}

}  // namespace
}  // namespace sinew::sim
