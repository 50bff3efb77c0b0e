#include "sinew/sim/simulation.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/run/inputs.hpp"
#include "sinew/run/state.hpp"
#include "sinew/world/world.hpp"

#include "../toys/gradient_solver.hpp"
#include "robots.hpp"
#include "support/error_kind.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::beam;
using sinew::testing::BeamOptions;
using sinew::testing::pull;
using sinew::testing::tension;

void run(Simulation& simulation, int steps) {
  for (int i = 0; i < steps; ++i) simulation.step();
}

using sinew::testing::kind_of;

TEST(Simulation, StaysAtRestWithoutInputs) {
  Simulation simulation(beam());
  const Points before = simulation.body(0).positions();
  run(simulation, 10);
  EXPECT_LT((simulation.body(0).positions() - before).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_DOUBLE_EQ(simulation.time(), 0.1);
}

TEST(Simulation, PulledCableGivesWayByTheLengthAsked) {
  Simulation simulation(beam());
  simulation.command(0, pull(0.002));
  run(simulation, 30);
  EXPECT_NEAR(simulation.actuator(0).motion, 0.002, 1e-12);
  EXPECT_GT(simulation.actuator(0).effort, 0.0);
  EXPECT_FALSE(simulation.actuator(0).slack);
  EXPECT_GT(simulation.effector_value(0).z(), 0.001);  // cable 0 lies on +z
}

TEST(Simulation, SlackCablesHaveExactlyNoTension) {
  Simulation simulation(beam());
  simulation.command(0, pull(0.003));
  for (int k : {1, 2, 3}) simulation.command(k, pull(-0.001));  // paid out
  run(simulation, 30);
  for (int k : {1, 3}) {
    EXPECT_EQ(simulation.actuator(k).effort, 0.0) << k;
    EXPECT_TRUE(simulation.actuator(k).slack);
    EXPECT_GT(simulation.actuator(k).motion, -0.001) << "a slack cable is shorter than its drive";
  }
}

TEST(Simulation, TensionAndLengthMayBeMixed) {
  Simulation simulation(beam());
  simulation.command(0, tension(0.5));
  simulation.command(1, pull(0.002));
  run(simulation, 40);
  EXPECT_EQ(simulation.actuator(0).effort, 0.5);
  EXPECT_NEAR(simulation.actuator(1).motion, 0.002, 1e-12);
  EXPECT_GT(simulation.actuator(1).effort, 0.0);
  EXPECT_LT(simulation.report().violation, 1e-12);
}

TEST(Simulation, StrokeHoldsATensionCommandBack) {
  BeamOptions options;
  options.displacement = {.min = -0.001, .max = 0.001};
  Simulation simulation(beam(options));
  simulation.command(0, tension(50.0));
  run(simulation, 40);
  EXPECT_NEAR(simulation.actuator(0).motion, 0.001, 1e-12);
  EXPECT_LT(simulation.actuator(0).effort, 50.0);
  EXPECT_GT(simulation.actuator(0).effort, 0.0);
}

TEST(Simulation, TensionLimitStallsALengthCommand) {
  BeamOptions options;
  options.tension = {.min = 0.0, .max = 0.2};
  Simulation simulation(beam(options));
  simulation.command(0, pull(0.05));
  run(simulation, 60);
  EXPECT_DOUBLE_EQ(simulation.actuator(0).effort, 0.2);
  EXPECT_LT(simulation.actuator(0).motion, 0.05);
}

TEST(Simulation, RateLimitsTheDrive) {
  BeamOptions options;
  options.displacement = {.rate = 0.05};
  Simulation simulation(beam(options));
  simulation.command(0, pull(0.003));
  for (int i = 1; i <= 10; ++i) {
    simulation.step();
    EXPECT_NEAR(simulation.actuator(0).setpoint, std::min(0.003, 0.0005 * i), 1e-15) << i;
  }
}

TEST(Simulation, StepsConvergeToTheStaticSolution) {
  Simulation stepped(beam());
  stepped.command(0, pull(0.004));
  run(stepped, 60);
  Simulation solved(beam());
  solved.command(0, pull(0.004));
  const statics::StaticReport report = solved.solve_static();
  EXPECT_EQ(report.status, run::NewtonStatus::converged);
  EXPECT_LE(report.relative_residual, 1e-10);
  EXPECT_LT((stepped.body(0).positions() - solved.body(0).positions()).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Simulation, StaticSolutionIsInEquilibriumWithItsTensions) {
  BeamOptions options;
  options.gravity = {0.0, 0.0, -9.81};
  Simulation simulation(beam(options));
  simulation.command(0, tension(1.0));
  simulation.command(1, pull(0.002));
  const statics::StaticReport report = simulation.solve_static();
  EXPECT_LE(report.relative_residual, 1e-10);
  EXPECT_NEAR(simulation.actuator(1).motion, 0.002, 1e-11);
  // Another quasi-static step changes nothing.
  const Vector3 tip = simulation.effector_value(0);
  simulation.step();
  EXPECT_LT((simulation.effector_value(0) - tip).norm(), 1e-9);
}

TEST(Simulation, NewtonStepsMeetTheEquationOfBackwardEuler) {
  BeamOptions options;
  options.gravity = {0.0, 0.0, -9.81};
  options.damping = {.mass = 0.5, .stiffness = 0.01};
  options.step.integrator = mechanics::Integrator::backward_euler;
  options.step.method = model::Method::newton;
  options.step.tangent = mechanics::Tangent::exact;
  options.step.tolerance = 1e-11;
  for (const auto mass : {fem::MassMatrix::lumped, fem::MassMatrix::consistent}) {
    options.mass = mass;
    Simulation simulation(beam(options));
    simulation.command(0, pull(0.003));
    for (int i = 0; i < 20; ++i) {
      const run::StepReport& report = simulation.step();
      EXPECT_LE(report.relative_residual, 1e-11);
      EXPECT_LT(report.iterations, 12);
    }
  }
}

// Newton's result does not depend on the tangent.
TEST(Simulation, RotatedAndExactTangentLeadToTheSameStep) {
  BeamOptions options;
  options.step.integrator = mechanics::Integrator::backward_euler;
  options.step.method = model::Method::newton;
  options.step.tolerance = 1e-12;
  options.damping = {.mass = 0.0, .stiffness = 0.005};
  options.step.tangent = mechanics::Tangent::corotated;
  Simulation rough(beam(options));
  options.step.tangent = mechanics::Tangent::exact;
  Simulation exact(beam(options));
  for (Simulation* simulation : {&rough, &exact}) {
    simulation->command(0,
                        {model::CommandKind::motion, model::Signal::ramp({0.0, 0.005, 0.0, 0.05})});
    run(*simulation, 5);
  }
  EXPECT_LT((rough.body(0).positions() - exact.body(0).positions()).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Simulation, FreeFallIsExactForBackwardEuler) {
  BeamOptions options;
  options.clamped = false;
  options.cables = 0;
  options.gravity = {0.0, 0.0, -9.81};
  options.step.integrator = mechanics::Integrator::backward_euler;
  Simulation simulation(beam(options));
  const Points start = simulation.body(0).positions();
  const int n = 50;
  run(simulation, n);
  // v_k = -g h k, z_n = -g h^2 n (n + 1) / 2
  const double h = options.step.time_step;
  const double fall = -9.81 * h * h * n * (n + 1) / 2;
  const Points moved = simulation.body(0).positions() - start;
  // Exact up to the rounding of 50 solves, which depends on how the library was compiled.
  EXPECT_NEAR(moved.col(2).maxCoeff() / fall, 1.0, 1e-11);
  EXPECT_NEAR(moved.col(2).minCoeff() / fall, 1.0, 1e-11);
  EXPECT_LT(moved.leftCols(2).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Simulation, MassDampingStopsAFreeBody) {
  BeamOptions options;
  options.clamped = false;
  options.cables = 0;
  options.damping = {.mass = 2.0, .stiffness = 0.0};
  options.gravity = {0.0, 0.0, -9.81};
  options.step.integrator = mechanics::Integrator::backward_euler;
  Simulation simulation(beam(options));
  run(simulation, 2000);  // terminal velocity g / alpha
  EXPECT_NEAR(simulation.body(0).velocities().col(2).mean(), -9.81 / 2.0, 1e-6);
}

TEST(Simulation, QuasiStaticStateDoesNotDependOnTheTimeStep) {
  std::vector<Vector3> tips;
  for (const double h : {1e-4, 1e-3, 1e-1}) {
    BeamOptions options;
    options.step.time_step = h;
    Simulation simulation(beam(options));
    simulation.command(0, tension(0.8));
    run(simulation, 60);
    tips.push_back(simulation.effector_value(0));
    EXPECT_EQ(simulation.actuator(0).effort, 0.8) << "efforts are newtons, not impulses";
  }
  EXPECT_LT((tips[0] - tips[1]).norm() + (tips[0] - tips[2]).norm(), 1e-12);
}

// Efforts do not depend on the step: W carries the factor h, not lambda.
TEST(Simulation, DynamicTensionIsInNewtons) {
  for (const double h : {1e-3, 1e-2}) {
    BeamOptions options;
    options.step.time_step = h;
    options.step.integrator = mechanics::Integrator::backward_euler;
    options.damping = {.mass = 5.0, .stiffness = 0.02};
    Simulation simulation(beam(options));
    simulation.command(0, pull(0.002));
    run(simulation, static_cast<int>(3.0 / h));
    Simulation settled(beam());
    settled.command(0, pull(0.002));
    settled.solve_static();
    EXPECT_NEAR(simulation.actuator(0).effort, settled.actuator(0).effort,
                1e-5 * settled.actuator(0).effort);
  }
}

TEST(Simulation, ResetRestoresTheStartBitForBit) {
  Simulation simulation(beam());
  const auto start = simulation.state().hash();
  simulation.command(0, pull(0.004));
  run(simulation, 20);
  const auto first = simulation.state().hash();
  EXPECT_NE(first, start);
  simulation.reset();
  EXPECT_EQ(simulation.state().hash(), start);
  EXPECT_EQ(simulation.steps(), 0);
  simulation.command(0, pull(0.004));
  run(simulation, 20);
  EXPECT_EQ(simulation.state().hash(), first);
}

TEST(Simulation, SimulationsOfOneModelDoNotTouchEachOther) {
  const auto model = beam();
  Simulation first(model), second(model);
  first.command(0, pull(0.004));
  run(first, 10);
  EXPECT_LT((second.effector_value(0) - Vector3(0.1, 0.0, 0.0)).norm(), 1e-15);
}

TEST(Simulation, AHugePullIsCutBackAndNothingInverts) {
  BeamOptions options;
  options.step.method = model::Method::one_linearisation;
  Simulation simulation(beam(options));
  simulation.command(0, tension(200.0));
  bool cut = false;
  try {
    for (int i = 0; i < 50; ++i) {
      const run::StepReport& report = simulation.step(OnFailure::keep_going);
      EXPECT_GT(report.smallest_volume_ratio, 0.0);
      EXPECT_TRUE(report.scale == 1.0 || is_flagged(report.status));
      cut = cut || report.scale < 1.0;
    }
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::inverted_in_run);
    EXPECT_NE(std::string(error.what()).find("beam"), std::string::npos);
    cut = true;
  }
  EXPECT_TRUE(cut);
  EXPECT_TRUE(simulation.body(0).positions().allFinite());
}

TEST(Simulation, NotANumberInAForceStopsTheRunAndKeepsTheState) {
  Simulation simulation(beam());
  simulation.command(0, pull(0.001));
  run(simulation, 5);
  const auto before = simulation.state().hash();
  mechanics::as<mechanics::TakesForces>(simulation.body(0))
      ->external_forces()(simulation.body(0).positions().rows() - 1, 0) = NAN;
  const auto kind = kind_of([&] { simulation.step(); });
  EXPECT_TRUE(kind == ErrorKind::diverged || kind == ErrorKind::not_converged ||
              kind == ErrorKind::singular_matrix)
      << error_kind_name(kind);
  EXPECT_EQ(simulation.state().hash(), before);
}

TEST(Simulation, StiffnessFactorsAreAboveZero) {
  Simulation simulation(beam());
  const run::Inputs good = simulation.inputs();
  for (const double wrong : {0.0, -1.0, static_cast<double>(NAN), kInfinity}) {
    run::Inputs inputs = good;
    inputs.bodies[0].stiffness_factor = wrong;
    EXPECT_EQ(kind_of([&] { simulation.set_inputs(inputs); }), ErrorKind::out_of_range) << wrong;
    EXPECT_EQ(kind_of([&] { simulation.set_stiffness_factor(0, wrong); }), ErrorKind::out_of_range)
        << wrong;
    EXPECT_EQ(simulation.inputs().bodies[0].stiffness_factor, 1.0);
  }
}

TEST(Simulation, BadModelsAreErrors) {
  BeamOptions loose;
  loose.clamped = false;
  EXPECT_EQ(kind_of([&] { beam(loose); }), ErrorKind::nothing_fixed);
  BeamOptions frozen;
  frozen.step.time_step = 0.0;
  EXPECT_EQ(kind_of([&] { beam(frozen); }), ErrorKind::out_of_range);
  BeamOptions antidamped;
  antidamped.damping.stiffness = -1.0;
  EXPECT_EQ(kind_of([&] { beam(antidamped); }), ErrorKind::out_of_range);
  BeamOptions backend;
  backend.factorisation.backend = "magic";
  EXPECT_EQ(kind_of([&] { beam(backend); }), ErrorKind::unknown_choice);
  const auto model = beam();
  EXPECT_EQ(kind_of([&] { (void)model->actuator_index("cable_9"); }), ErrorKind::unknown_name);
  EXPECT_EQ(kind_of([&] { (void)model->effector_index("tpi"); }), ErrorKind::unknown_name);
}

TEST(Simulation, BackendsAgree) {
  std::vector<Vector3> tips;
  for (const char* backend : {"block", "eigen-ldlt", "eigen-llt", "gradients"}) {
    BeamOptions options;
    options.factorisation.backend = backend;
    Simulation simulation(beam(options));
    simulation.command(0, pull(0.004));
    simulation.command(1, tension(0.3));
    run(simulation, 20);
    tips.push_back(simulation.effector_value(0));
  }
  EXPECT_LT((tips[0] - tips[1]).norm(), 1e-11);
  EXPECT_LT((tips[0] - tips[2]).norm(), 1e-11);
  EXPECT_LT((tips[0] - tips[3]).norm(), 1e-9) << "conjugate gradients";
}

// Newton's method works with a solver that does not count negative directions; searches for
// equilibria say that they need to know.
TEST(Simulation, SolversNeedNotKnowTheInertia) {
  std::vector<Vector3> tips;
  for (const char* backend : {"block", "gradients"}) {
    BeamOptions options;
    options.factorisation.backend = backend;
    options.step.method = model::Method::newton;
    Simulation simulation(beam(options));
    simulation.command(1, tension(0.3));
    run(simulation, 3);
    if (backend == std::string_view("gradients")) {
      EXPECT_EQ(kind_of([&] { simulation.solve_static(); }), ErrorKind::not_in_this_version);
    }
    tips.push_back(simulation.effector_value(0));
  }
  EXPECT_LT((tips[0] - tips[1]).norm(), 1e-8);
}

// W is the derivative of the nonlinear equilibrium; central differences of tensions.
TEST(Simulation, ComplianceIsTheDerivativeOfTheStatics) {
  Simulation simulation(beam());
  const std::vector<double> at = {1.2, 0.5, 0.2, 0.8};
  const auto settle = [&](int k, double more) {
    for (int i = 0; i < 4; ++i) {
      simulation.command(i, tension(at[static_cast<std::size_t>(i)] + (i == k ? more : 0.0)));
    }
    simulation.solve_static({.tolerance = 1e-12});
    return VectorX(simulation.world().measure_delta());
  };
  settle(0, 0.0);
  const std::vector<int> cables = {0, 1, 2, 3};
  auto& world = simulation.world();
  world.linearise({{}, mechanics::Tangent::exact, true, false});
  world.form_rows(simulation.efforts(), cables);
  ASSERT_EQ(world.condense(), linalg::FactorStatus::positive_definite);
  const MatrixX w = world.problem().compliance;
  const double h = 1e-4;
  for (int k = 0; k < 4; ++k) {
    const VectorX column = (settle(k, h) - settle(k, -h)) / (2 * h);
    EXPECT_LT((w.col(k) - column).norm(), 1e-6 * column.norm()) << k;
  }
}

}  // namespace
}  // namespace sinew::sim
