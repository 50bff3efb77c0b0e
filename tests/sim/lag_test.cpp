// The residual that following quasi-static steps may leave to the next one, and the cases in which
// they must not.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/force_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/material/hyperelastic.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/sim/simulation.hpp"

#include "sim/robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::beam;
using sinew::testing::BeamOptions;

constexpr double kSide = 0.02;  // m
constexpr double kC1 = 1e4, kC2 = 2e2, kC3 = 5.0;
constexpr material::MullinsEffect kSoftening{.r = 1.6, .m = 900.0, .beta = 0.05};

// A cube on rollers (one hexahedron), stretched along x by four forces.
std::shared_ptr<const model::Model> cube(material::Hyperelastic rubber,
                                         const model::StepSettings& step) {
  builder::ModelBuilder builder(step);
  fem::FemBodySettings body;
  body.name = "cube";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.corner = Vector3::Zero(), .size = Vector3::Constant(kSide), .cells = {1, 1, 1}},
                  mesh::Cells::hexahedra));
  body.mesh = mesh;
  rubber.bulk_modulus = material::bulk_modulus_of(rubber.shear_modulus(), 0.4999);
  fem::MaterialRegion region;
  region.hyperelastic = std::move(rubber);
  body.elements.regions = {std::move(region)};
  for (int axis = 0; axis < 3; ++axis) {
    const std::string side(1, "xyz"[axis]);
    for (const NodeId node : mesh->node_sets.at(side + "_min")) {
      body.elements.held_axes.push_back({node, axis});
    }
  }
  const int number = builder.add_body<fem::FemBodyModel>(std::move(body));
  for (const NodeId node : mesh->node_sets.at("x_max")) {
    builder::ForceSettings force;
    force.name = "force_" + std::to_string(node);
    force.body = number;
    force.point = mesh->nodes.row(node);
    force.direction = Vector3::UnitX();
    builder.add_force(force);
  }
  return builder.build();
}

// Nominal stress after each step to a stretch, Pa.
std::vector<double> stresses(const std::shared_ptr<const model::Model>& model,
                             const std::vector<double>& stretches) {
  Simulation simulation(model);
  std::vector<double> result;
  for (const double stretch : stretches) {
    for (int k = 0; k < 4; ++k) {
      simulation.command(k, sinew::testing::pull(kSide * (stretch - 1.0)));
    }
    simulation.step();
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) sum += simulation.actuator(k).effort;
    result.push_back(sum / (kSide * kSide));
  }
  return result;
}

// Loading, unloading, loading to a larger stretch, unloading.
std::vector<double> cycles() {
  std::vector<double> stretches;
  double last = 1.0;
  for (const double turn : {2.0, 1.02, 2.4, 1.3}) {
    for (int k = 1; k <= 100; ++k) stretches.push_back(last + 0.01 * k * (turn - last));
    last = turn;
  }
  return stretches;
}

// Incompressible Yeoh solid in tension with softening (Ogden & Roxburgh, Proc. R. Soc. A 455 (1999)
// 2861).
double softened_stress(double stretch, double& peak) {
  const double i = stretch * stretch + 2.0 / stretch - 3.0;
  const double energy = kC1 * i + kC2 * i * i + kC3 * i * i * i;
  const double slope = kC1 + 2.0 * kC2 * i + 3.0 * kC3 * i * i;
  peak = std::max(peak, energy);
  const double left = std::erf((peak - energy) / (kSoftening.m + kSoftening.beta * peak));
  return 2.0 * slope * (stretch - 1.0 / (stretch * stretch)) * (1.0 - left / kSoftening.r);
}

TEST(Lag, SofteningRubberTurnsWhereItsFormulaTurns) {
  material::Hyperelastic rubber = material::yeoh({kC1, kC2, kC3});
  rubber.mullins = kSoftening;
  const std::vector<double> stretches = cycles();
  const std::vector<double> found = stresses(cube(rubber, {}), stretches);
  double peak = 0.0;
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    const double expected = softened_stress(stretches[k], peak);
    EXPECT_NEAR(found[k], expected, 2e-3 * std::max(std::abs(expected), 1e3)) << stretches[k];
  }
}

TEST(Lag, ViscousRubberKeepsNoErrorOfAStep) {
  material::Hyperelastic rubber = material::neo_hookean(2e4);
  rubber.prony = {{0.3, 0.05}, {0.2, 0.5}};
  const model::StepSettings exact{.tolerance = 1e-12};
  const std::vector<double> expected = stresses(cube(rubber, exact), cycles());
  const std::vector<double> found = stresses(cube(rubber, {}), cycles());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(found[k], expected[k], 1e-5 * std::max(std::abs(expected[k]), 1e3)) << k;
  }
}

// Largest relative residual over the steps of a beam that a cable bends.
double largest_residual(const model::StepSettings& step) {
  BeamOptions options;
  options.step = step;
  Simulation simulation(beam(options));
  simulation.command(0, {model::CommandKind::motion, model::Signal::ramp({0.0, 0.02, 0.0, 0.2})});
  double largest = 0.0;
  for (int k = 0; k < 20; ++k) {
    largest = std::max(largest, simulation.step().relative_residual);
    EXPECT_EQ(simulation.report().status, run::StepStatus::solved);
  }
  return largest;
}

TEST(Lag, StepsConvergeUnlessTheyFollow) {
  EXPECT_LE(largest_residual({}), model::kQuasiStaticTolerance);
  EXPECT_GT(largest_residual({.equilibrium = model::Equilibrium::following}),
            1.2 * model::kFollowingTolerance);
}

// An explicit tolerance is met, even if it equals the default of following steps.
TEST(Lag, AToleranceThatIsAskedForIsKept) {
  for (const double tolerance : {model::kFollowingTolerance, 1e-7}) {
    EXPECT_LE(
        largest_residual({.equilibrium = model::Equilibrium::following, .tolerance = tolerance}),
        tolerance);
  }
}

TEST(Lag, OnlyAModelWithoutAWordFollowsWhenAsked) {
  for (const auto word :
       {std::optional<model::Equilibrium>(), std::optional(model::Equilibrium::converged),
        std::optional(model::Equilibrium::following)}) {
    BeamOptions options;
    options.step.equilibrium = word;
    Simulation simulation(beam(options));
    EXPECT_EQ(simulation.equilibrium(), word.value_or(model::Equilibrium::converged));
    simulation.follow();
    EXPECT_EQ(simulation.equilibrium(), word.value_or(model::Equilibrium::following));
    EXPECT_EQ(simulation.clone()->equilibrium(), simulation.equilibrium());
    simulation.follow(false);
    EXPECT_EQ(simulation.equilibrium(), word.value_or(model::Equilibrium::converged));
  }
}

}  // namespace
}  // namespace sinew::sim
