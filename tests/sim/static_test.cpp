// Statics: stable equilibria, loads at which Newton's method alone fails, nearly incompressible
// bodies, and searches that end at rounding.
#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "sinew/builder/effector_settings.hpp"
#include "sinew/builder/force_settings.hpp"
#include "sinew/builder/load_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/stability.hpp"
#include "sinew/world/world.hpp"

#include "robots.hpp"

namespace sinew::sim {
namespace {

constexpr double kLength = 0.1, kSide = 0.005;

fem::FemBodySettings block(const Vector3& size, const std::array<int, 3>& cells, mesh::Cells kind,
                           double young, double poisson) {
  fem::FemBodySettings body;
  body.name = "block";
  body.mesh = std::make_shared<const mesh::Mesh>(mesh::block({.size = size, .cells = cells}, kind));
  fem::MaterialRegion region;
  region.hyperelastic = material::neo_hookean(young / (2.0 * (1.0 + poisson)));
  region.hyperelastic->bulk_modulus = young / (3.0 * (1.0 - 2.0 * poisson));
  region.density = 1000.0;
  body.elements.regions = {region};
  body.elements.fixed_nodes = body.mesh->node_sets.at("x_min");
  return body;
}

/// A slender column along x, clamped at one end; an actuator can compress its tip along x.
std::shared_ptr<const model::Model> column() {
  builder::ModelBuilder builder;
  builder.add_body<fem::FemBodyModel>(
      block({kLength, kSide, kSide}, {20, 2, 2}, mesh::Cells::hexahedra, 1e6, 0.3));
  builder::ForceSettings press;
  press.name = "press";
  press.point = {kLength, kSide / 2, kSide / 2};
  press.direction = {-1.0, 0.0, 0.0};
  builder.add_force(press);
  builder::EffectorSettings tip;
  tip.name = "tip";
  tip.points = press.point.transpose();
  builder.add_effector(tip);
  return builder.build();
}

Vector3 tip_motion(const Simulation& simulation) {
  return simulation.effector_value(0) - Vector3(kLength, kSide / 2, kSide / 2);
}

double aside(const Simulation& simulation) { return tip_motion(simulation).tail<2>().norm(); }

/// Buckling load of the column's mesh to 1e-3, N: the first negative pivot of the straight column.
double buckling_load(const std::shared_ptr<const model::Model>& model) {
  const double inertia = std::pow(kSide, 4) / 12.0;
  const double euler = std::pow(std::numbers::pi / (2.0 * kLength), 2) * 1e6 * inertia;
  double low = 0.5 * euler, high = 1.5 * euler;
  while (high - low > 1e-3 * euler) {
    const double load = 0.5 * (low + high);
    Simulation straight(model);
    straight.command(0, sinew::testing::tension(load));
    const auto report = straight.solve_static({.stability = statics::StabilityChoice::any});
    (report.negative_pivots > 0 ? high : low) = load;
  }
  // Two hexahedra across are too stiff in bending.
  EXPECT_GT(0.5 * (low + high), 0.98 * euler);
  EXPECT_LT(0.5 * (low + high), 1.4 * euler);
  return 0.5 * (low + high);
}

/// Deflection and approach of the tip, relative to the length, of a clamped-free elastica under a
/// dead load of `ratio` times Euler's (Timoshenko & Gere, Theory of Elastic Stability, 1961, sec.
/// 2.7):
///   K(k) = pi/2 sqrt(P/P_E), y = 2 k / K, x = 1 - (2 E(k)/K - 1).
std::pair<double, double> elastica(double ratio) {
  const double wanted = 0.5 * std::numbers::pi * std::sqrt(ratio);
  double low = 0.0, high = 1.0 - 1e-12;
  for (int i = 0; i < 100; ++i) {
    const double k = 0.5 * (low + high);
    (std::comp_ellint_1(k) < wanted ? low : high) = k;
  }
  return {2.0 * low / wanted, 2.0 - 2.0 * std::comp_ellint_2(low) / wanted};
}

TEST(Statics, AColumnPastEulersLoadBuckles) {
  const auto model = column();
  const double critical = buckling_load(model);
  for (const double ratio : {1.1, 2.0, 5.0}) {
    Simulation simulation(model);
    simulation.command(0, sinew::testing::tension(ratio * critical));
    const statics::StaticReport report = simulation.solve_static();
    EXPECT_EQ(report.status, run::NewtonStatus::converged);
    EXPECT_TRUE(report.stable);
    EXPECT_EQ(report.negative_pivots, 0);
    EXPECT_GT(report.relaxation_steps, 0);
    const auto [deflection, approach] = elastica(ratio);
    EXPECT_NEAR(aside(simulation), deflection * kLength, 0.03 * kLength) << ratio;
    EXPECT_NEAR(-tip_motion(simulation).x(), approach * kLength, 0.03 * kLength) << ratio;
  }
  Simulation below(model);
  below.command(0, sinew::testing::tension(0.9 * critical));
  EXPECT_EQ(below.solve_static().relaxation_steps, 0);
  EXPECT_LT(aside(below), 1e-9);
}

TEST(Statics, TheSameColumnBucklesTheSameWay) {
  const auto model = column();
  Simulation one(model), other(model);
  for (Simulation* simulation : {&one, &other}) {
    simulation->command(0, sinew::testing::tension(2e-2));
    simulation->solve_static();
  }
  EXPECT_EQ(one.state().hash(), other.state().hash());
}

TEST(Statics, AnUnstableBranchIsKeptAndNamed) {
  Simulation simulation(column());
  simulation.command(0, sinew::testing::tension(2e-2));
  const statics::StaticReport report =
      simulation.solve_static({.stability = statics::StabilityChoice::any});
  EXPECT_EQ(report.negative_pivots, 2);  // one per lateral direction
  EXPECT_FALSE(report.stable);
  EXPECT_LT(aside(simulation), 1e-6);
}

/// m, about three times the shortening L P_E/(E A) at which the straight column buckles.
constexpr double kThrice = 1.5e-4;

// Compressed by a commanded motion, the column still buckles sideways.
TEST(Statics, ACommandedMotionHoldsWhatItCommandsAlone) {
  const auto model = column();
  const double critical = buckling_load(model);
  Simulation simulation(model);
  simulation.command(0, sinew::testing::pull(kThrice));
  EXPECT_EQ(simulation.solve_static({.stability = statics::StabilityChoice::any}).negative_pivots,
            2);
  simulation.reset();
  simulation.command(0, sinew::testing::pull(kThrice));
  const statics::StaticReport report = simulation.solve_static();
  EXPECT_EQ(report.negative_pivots, 0);
  EXPECT_NEAR(simulation.actuator(0).motion, kThrice, 1e-9);
  EXPECT_GT(aside(simulation), 0.002);
  EXPECT_NEAR(simulation.actuator(0).effort, critical, 0.1 * critical);
}

// Compares the number of negative pivots and the curvature with the dense tangent on the null space
// of the held row.
TEST(Statics, StabilityAgreesWithTheDenseTangent) {
  for (const bool held : {false, true}) {
    Simulation simulation(column());
    simulation.command(0, held ? sinew::testing::pull(kThrice) : sinew::testing::tension(5e-2));
    const statics::StaticReport report =
        simulation.solve_static({.stability = statics::StabilityChoice::any});
    world::World& world = simulation.world();
    world.begin_query(0.0);
    world.linearise({{}, mechanics::Tangent::exact, true, false});
    world.form_rows(simulation.efforts(), simulation.model().geometric_stiffness().all);
    ASSERT_NE(world.condense(), linalg::FactorStatus::singular);
    const world::Stability stability(world, simulation.efforts());
    VectorX rest, row;
    world.bodies().imbalance(std::vector<double>(simulation.efforts().size(), 0.0), rest);
    std::vector<double> unit(simulation.efforts().size(), 0.0);
    unit[static_cast<std::size_t>(simulation.model().actuators()[0].row)] = 1.0;
    world.bodies().imbalance(unit, row);
    row -= rest;
    MatrixX inverse(rest.size(), rest.size());
    VectorX column;
    for (Eigen::Index j = 0; j < rest.size(); ++j) {
      world.bodies().solve(VectorX::Unit(rest.size(), j), column);
      inverse.col(j) = column;
    }
    MatrixX tangent = linalg::solve(inverse, MatrixX::Identity(rest.size(), rest.size()));
    if (held) {  // moves the direction of the row far above
      const VectorX along = row.normalized();
      const MatrixX across =
          MatrixX::Identity(rest.size(), rest.size()) - along * along.transpose();
      tangent = across * tangent * across + 1e6 * along * along.transpose();
    }
    const VectorX values = linalg::symmetric_eigenvalues(0.5 * (tangent + tangent.transpose()));
    const auto negative = static_cast<int>((values.array() < 0.0).count());
    ASSERT_GE(negative, 2) << held << " " << values.head(4).transpose() << " pivots "
                           << stability.negative_pivots() << " report " << report.negative_pivots
                           << " status " << static_cast<int>(report.status);
    EXPECT_EQ(stability.negative_pivots(), negative);
    EXPECT_EQ(report.negative_pivots, negative);
    const VectorX& mode = stability.mode();
    if (held) {
      EXPECT_NEAR(row.dot(mode), 0.0, 1e-9 * row.norm() * mode.norm());
    }
    EXPECT_NEAR(mode.dot(tangent * mode), stability.curvature(),
                1e-4 * std::abs(stability.curvature()));
    EXPECT_LT(stability.curvature() / mode.squaredNorm(), 0.9 * values[0]);
  }
}

/// A strip under a pressure on its upper side, Pa per load factor.
std::shared_ptr<const model::Model> strip() {
  builder::ModelBuilder builder;
  auto body = block({0.1, 0.02, 0.01}, {20, 4, 2}, mesh::Cells::hexahedra, 1e5, 0.4);
  const auto faces = mesh::select_faces(*body.mesh, mesh::NamedRegion{"z_max"}, "top");
  builder.add_body<fem::FemBodyModel>(std::move(body));
  builder.add_load({.name = "wind", .load = builder::PressureLoadSettings{faces}});
  builder::EffectorSettings tip;
  tip.name = "tip";
  tip.points = Vector3(0.1, 0.01, 0.005).transpose();
  builder.add_effector(tip);
  return builder.build();
}

TEST(Statics, AStripIsCurledPastItsBaseByAPressureThatFollowsIt) {
  Simulation simulation(strip());
  for (const double pressure : {170.0, 300.0}) {
    simulation.reset();
    simulation.set_load(0, model::Signal::constant(pressure));
    const statics::StaticReport report = simulation.solve_static();
    EXPECT_EQ(report.status, run::NewtonStatus::converged);
    EXPECT_LT(report.relative_residual, 1e-10);
    EXPECT_TRUE(report.stable);
    EXPECT_LT(simulation.effector_value(0).x(), 0.0);
  }
}

// A cantilever sags under its weight by a third of its length, in a few iterations and by nearly
// the same amount at any compressibility.
TEST(Statics, IterationsDoNotGrowTowardsIncompressibility) {
  for (const auto kind : {mesh::Cells::hexahedra, mesh::Cells::quadratic}) {
    double first = 0.0;
    for (const double poisson : {0.45, 0.499, 0.4999, 0.49999999}) {
      builder::ModelBuilder builder;
      auto body = block({0.1, 0.02, 0.02}, {10, 2, 2}, kind, 1e5, poisson);
      body.gravity = {0.0, 0.0, -9.81};
      builder.add_body<fem::FemBodyModel>(std::move(body));
      Simulation simulation(builder.build());
      const statics::StaticReport report = simulation.solve_static();
      EXPECT_EQ(report.load_steps, 1);
      EXPECT_LE(report.iterations, 12) << poisson;
      EXPECT_TRUE(report.stable);
      const Points moved = simulation.body(0).positions() - simulation.body(0).model().mesh().nodes;
      const double sag = -moved.col(2).minCoeff();
      if (first == 0.0) first = sag;
      EXPECT_GT(sag, 0.02);
      EXPECT_NEAR(sag, first, 0.03 * first) << poisson;
    }
  }
}

// There is nothing to solve, but the residual contains rounding of M/h^2 eps |x|.
TEST(Newton, EndsWhereRoundingDoesInSmallSteps) {
  for (const auto integrator : {mechanics::Integrator::backward_euler, mechanics::Integrator::bdf2,
                                mechanics::Integrator::generalized_alpha}) {
    for (const double time_step : {1e-4, 1e-5, 1e-6}) {
      model::StepSettings step;
      step.time_step = time_step;
      step.integrator = integrator;
      step.method = model::Method::newton;
      Simulation simulation(sinew::testing::beam({.step = step, .cables = 0, .clamped = false}));
      auto& body = *mechanics::as<mechanics::TakesForces>(simulation.body(0));
      const double push = 0.1 / (20.0 * time_step);  // m/s^2: 0.1 m/s after 20 steps
      const VectorX& masses =
          mechanics::as<const fem::HasElements>(simulation.body(0).model())->elements().load_mass();
      simulation.step();
      body.external_forces().col(2) = push * masses;
      for (int i = 0; i < 20; ++i) simulation.step();
      body.external_forces().setZero();
      ASSERT_NO_THROW({
        for (int i = 0; i < 100; ++i) simulation.step();
      }) << time_step;
      EXPECT_NEAR(simulation.body(0).velocities().col(2).mean(), 0.1, 1e-3);
    }
  }
}

}  // namespace
}  // namespace sinew::sim
