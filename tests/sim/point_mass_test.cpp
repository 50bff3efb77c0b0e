// Point masses attached to bodies.
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/load_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {
namespace {

using mechanics::Integrator;

enum class PointMassKind { tet4, patches, tet10, hex8 };

constexpr double kGravity = 9.81;
const Vector3 kPoint(0.057, 0.004, 0.013);

/// A cantilever of rubber along x, 60 x 20 x 20 mm.
fem::FemBodySettings cantilever(PointMassKind kind,
                                std::vector<fem::PointMassSettings> masses = {}) {
  fem::FemBodySettings body;
  body.name = "beam";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.size = {0.06, 0.02, 0.02}, .cells = {6, 2, 2}},
                  kind == PointMassKind::tet10  ? mesh::Cells::quadratic
                  : kind == PointMassKind::hex8 ? mesh::Cells::hexahedra
                                                : mesh::Cells::tetrahedra));
  body.mesh = mesh;
  fem::MaterialRegion region;
  region.hyperelastic = material::neo_hookean(4e4);
  region.hyperelastic->bulk_modulus = 2e5;
  region.density = 1000.0;
  region.patches = kind == PointMassKind::patches;
  body.elements.regions = {region};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  body.gravity = {0.0, 0.0, -kGravity};
  body.masses = std::move(masses);
  return body;
}

fem::PointMassSettings hung(double mass, const Vector3& point = kPoint) {
  return {"hung", {}, point, mass, mesh::Outside::error};
}

class HungMass : public ::testing::TestWithParam<PointMassKind> {};

TEST_P(HungMass, SagsTheBeamAsItsWeightDoes) {
  builder::ModelBuilder weighed, pulled;
  weighed.add_body<fem::FemBodyModel>(cantilever(GetParam(), {hung(0.02)}));
  pulled.add_body<fem::FemBodyModel>(cantilever(GetParam()));
  pulled.add_load(
      {.name = "weight", .load = builder::PointLoadSettings{kPoint, {0.0, 0.0, -0.02 * kGravity}}});
  Simulation a(weighed.build()), b(pulled.build());
  a.solve_static();
  b.solve_static();
  const Points moved = a.body(0).positions() - a.body(0).model().mesh().nodes;
  EXPECT_LT(moved.col(2).minCoeff(), -2e-3);
  EXPECT_LT((a.body(0).positions() - b.body(0).positions()).cwiseAbs().maxCoeff(), 1e-10);
  // Its potential energy is that of the height it lost.
  const model::MassModel& mass = a.model().masses()[0];
  const double lost = kPoint.z() - a.body(0).position(mass.point).z();
  EXPECT_NEAR(b.energies().gravity - a.energies().gravity, 0.02 * kGravity * lost,
              1e-8 * kGravity * lost);
}

// M = M of the material + m N^T N, checked by the kinetic energy of arbitrary velocities, by the
// momentum (its derivative), and in the matrix that a step factorises.
TEST_P(HungMass, HasTheInertiaOfItsPoint) {
  for (const auto matrix : {fem::MassMatrix::lumped, fem::MassMatrix::consistent}) {
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0.0, 1.0);
    // The second mass is in an element with fixed nodes.
    std::vector<fem::PointMassSettings> masses{hung(0.02), hung(0.03, {0.004, 0.003, 0.008})};
    masses[1].name = "low";
    auto bare_settings = cantilever(GetParam()), settings = cantilever(GetParam(), masses);
    bare_settings.elements.mass = settings.elements.mass = matrix;
    const fem::FemBodyModel bare(bare_settings), model(settings);
    const auto count = 3 * static_cast<std::size_t>(model.elements().free_count());
    std::vector<double> velocity(count), momentum(count), without(count);
    for (double& v : velocity) v = noise(random);
    model.elements().apply_mass(velocity, momentum);
    bare.elements().apply_mass(velocity, without);
    const auto free = model.elements().free_index();
    std::vector<double> expected = without;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& at = model.attachment(model.mass_point(k));
      Vector3 v = Vector3::Zero();
      const auto visit = [&](auto&& use) {
        for (std::size_t a = 0; a < at.nodes.size(); ++a) {
          const auto i = free[static_cast<std::size_t>(at.nodes[a])];
          if (i >= 0) use(3 * static_cast<std::size_t>(i), at.weights[a]);
        }
      };
      visit([&](std::size_t i, double w) { v += w * Vector3(&velocity[i]); });
      visit([&](std::size_t i, double w) {
        for (std::size_t c = 0; c < 3; ++c)
          expected[i + c] += masses[k].mass * w * v[static_cast<int>(c)];
      });
    }
    for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(momentum[i], expected[i], 1e-16);
  }
}

INSTANTIATE_TEST_SUITE_P(Elements, HungMass,
                         ::testing::Values(PointMassKind::tet4, PointMassKind::patches,
                                           PointMassKind::tet10, PointMassKind::hex8));

// Frequency of a light beam with a mass at its end: sqrt(3 E I / (L^3 (m + 33/140 m_beam)))
// (Rayleigh, Theory of Sound, 1877, art. 182).
TEST(PointMass, SwingsALightBeamAtItsFrequency) {
  const double young = 1e6, length = 0.2, side = 0.01, density = 1000.0, end = 0.2;
  model::StepSettings step;
  step.integrator = Integrator::generalized_alpha;
  step.spectral_radius = 1.0;
  step.method = model::Method::newton;
  step.tangent = mechanics::Tangent::exact;
  const double moment = std::pow(side, 4) / 12.0, beam = density * side * side * length;
  const double stiffness = 3.0 * young * moment / std::pow(length, 3);
  const double period = 2.0 * std::numbers::pi / std::sqrt(stiffness / (end + 33.0 / 140.0 * beam));
  step.time_step = period / 200.0;
  builder::ModelBuilder builder(step);
  fem::FemBodySettings body;
  body.name = "beam";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.size = {length, side, side}, .cells = {20, 1, 1}}, mesh::Cells::quadratic));
  body.mesh = mesh;
  fem::MaterialRegion region;
  region.hyperelastic = material::neo_hookean(young / 2.6);
  region.hyperelastic->bulk_modulus = young / 1.2;  // nu = 0.3
  region.density = density;
  body.elements.regions = {region};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  body.masses = {hung(end, {length, 0.5 * side, 0.5 * side})};
  builder.add_body<fem::FemBodyModel>(std::move(body));
  builder.add_load({.name = "pull",
                    .load = builder::PointLoadSettings{{length, 0.5 * side, 0.5 * side},
                                                       {0.0, 0.0, 1e-3 * length * stiffness}}});
  Simulation simulation(builder.build());
  simulation.solve_static();
  simulation.set_load(0, model::Signal::constant(0.0));
  const int point = simulation.model().masses()[0].point;
  const auto height = [&] { return simulation.body(0).position(point).z() - 0.5 * side; };
  double before = height();
  EXPECT_NEAR(before, 1e-3 * length, 0.02e-3 * length);
  std::vector<double> crossings;
  while (crossings.size() < 3) {
    simulation.step();
    const double now = height();
    if (before * now < 0.0) {
      crossings.push_back(simulation.time() - step.time_step * now / (now - before));
    }
    before = now;
  }
  EXPECT_NEAR(crossings[2] - crossings[0], period, 0.005 * period);
}

// Energy of a swing with a heavy mass, and momentum of a throw.
TEST(PointMass, KeepsEnergyAndMomentum) {
  model::StepSettings step;
  step.integrator = Integrator::generalized_alpha;
  step.spectral_radius = 1.0;
  step.method = model::Method::newton;
  step.tangent = mechanics::Tangent::exact;
  step.time_step = 1e-3;
  step.tolerance = 1e-11;
  builder::ModelBuilder builder(step);
  builder.add_body<fem::FemBodyModel>(cantilever(PointMassKind::tet4, {hung(0.05)}));
  fem::FemBodySettings thrown = cantilever(PointMassKind::hex8, {hung(0.03)});
  thrown.name = "thrown";
  thrown.masses[0].name = "ballast";
  thrown.elements.fixed_nodes.clear();
  thrown.initial_velocity = {{0.3, 0.0, 1.0}, {0.0, 2.0, 1.0}};
  builder.add_body<fem::FemBodyModel>(std::move(thrown));
  Simulation simulation(builder.build());
  ASSERT_EQ(simulation.model().masses().size(), 2u);
  EXPECT_EQ(simulation.model().mass_index("ballast"), 1);
  EXPECT_EQ(simulation.model().masses()[1].body, 1);
  const mechanics::Body& body = simulation.body(1);
  const VectorX& mass = mechanics::as<const fem::HasElements>(body.model())->elements().load_mass();
  EXPECT_NEAR(mass.sum(), 1000.0 * 2.4e-5 + 0.03, 1e-15);
  const auto centre = [&] { return Vector3(body.positions().transpose() * mass / mass.sum()); };
  const Vector3 start = centre();
  const double begin = simulation.energies().kinetic;
  EXPECT_GT(begin, 0.5 * mass.sum() * 1.09);
  double swing = 0.0, drift = 0.0;
  for (int k = 0; k < 200; ++k) {
    simulation.step();
    const mechanics::Energies now = simulation.energies();
    swing = std::max(swing, std::abs(now.kinetic - begin));
    drift = std::max(drift, std::abs(now.kinetic + now.strain + now.gravity - begin));
  }
  EXPECT_GT(swing, 5e-3);
  EXPECT_LT(drift, 0.01 * swing);
  const double t = simulation.time();
  // The first step is by backward Euler, which is off by h g t / 2.
  const Vector3 flight(0.3 * t, 0.0, t - 0.5 * kGravity * t * t);
  EXPECT_LT((centre() - start - flight).norm(), 0.6 * step.time_step * kGravity * t);
}

TEST(PointMass, IsPartOfTheRobot) {
  const auto fingerprint = [](std::vector<fem::PointMassSettings> masses) {
    builder::ModelBuilder builder;
    builder.add_body<fem::FemBodyModel>(cantilever(PointMassKind::tet4, std::move(masses)));
    return builder.build()->fingerprint();
  };
  const auto with = fingerprint({hung(0.02)});
  EXPECT_NE(with, fingerprint({}));
  EXPECT_NE(with, fingerprint({hung(0.021)}));
  EXPECT_NE(with, fingerprint({hung(0.02, {0.05, 0.004, 0.013})}));
  EXPECT_EQ(with, fingerprint({hung(0.02)}));
}

TEST(PointMass, BadOnesAreErrors) {
  const auto kind_of = [](std::vector<fem::PointMassSettings> masses) {
    for (fem::PointMassSettings& mass : masses) mass.place.line = 7;
    try {
      builder::ModelBuilder().add_body<fem::FemBodyModel>(
          cantilever(PointMassKind::tet4, std::move(masses)));
    } catch (const Error& error) {
      EXPECT_FALSE(error.remedy().empty());
      return error.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(kind_of({hung(0.0)}), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of({hung(-1.0)}), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of({hung(NAN)}), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of({hung(0.01, {1.0, 0.0, 0.0})}), ErrorKind::point_outside_mesh);
  EXPECT_EQ(kind_of({hung(0.01), hung(0.02)}), ErrorKind::duplicate_key);
  fem::FemBodySettings far = cantilever(PointMassKind::tet4);
  far.elements.point_masses = {
      {{0, static_cast<NodeId>(far.mesh->nodes.rows()) - 1}, {0.5, 0.5}, 1.0}};
  far.elements.fixed_nodes = {1, 2, 3};
  EXPECT_THROW(fem::FemBodyModel{far}, Error);
}

}  // namespace
}  // namespace sinew::sim
