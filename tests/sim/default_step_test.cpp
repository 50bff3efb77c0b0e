// A step with default settings: an accurate result, or a status that says otherwise.
#include <cmath>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "sim/robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::beam;
using sinew::testing::BeamOptions;
using sinew::testing::pull;
using sinew::testing::tension;

double distance(const Points& a, const Points& b) { return (a - b).rowwise().norm().maxCoeff(); }

// Distance between the present state and the equilibrium found from there.
double distance_to_rest(Simulation& simulation) {
  const Points stepped = simulation.body(0).positions();
  simulation.solve_static();
  return distance(stepped, simulation.body(0).positions());
}

TEST(DefaultStep, RemediesDoNotNameWhatIsChosen) {
  model::StepSettings step;
  step.method = model::Method::one_linearisation;
  const auto remedy = [&] { return step_status_remedy(run::StepStatus::not_in_equilibrium, step); };
  EXPECT_NE(remedy().find("use `solver: newton`"), std::string::npos);
  step.method = model::Method::newton;
  EXPECT_EQ(remedy(), "take a smaller time step, or change commands more slowly");
  step.tangent = mechanics::Tangent::corotated;
  EXPECT_NE(remedy().find("use `tangent: exact`"), std::string::npos);
}

TEST(DefaultStep, APulledCableBendsTheBeamToItsEquilibrium) {
  for (const double length : {0.002, 0.01, 0.02}) {
    Simulation simulation(beam());
    simulation.command(0,
                       {model::CommandKind::motion, model::Signal::ramp({0.0, length, 0.0, 0.2})});
    for (int k = 0; k < 25; ++k) {
      simulation.step();
      ASSERT_EQ(simulation.report().status, run::StepStatus::solved) << length;
    }
    EXPECT_NEAR(simulation.actuator(0).motion, length, 1e-6);
    EXPECT_LT(distance_to_rest(simulation), 1e-5) << length;
  }
}

TEST(DefaultStep, ACommandThatJumpsIsReachedInTheStep) {
  Simulation simulation(beam());
  simulation.command(0, pull(0.01));
  simulation.step();
  EXPECT_EQ(simulation.report().status, run::StepStatus::solved);
  EXPECT_NEAR(simulation.actuator(0).motion, 0.01, 1e-5);
  EXPECT_LT(distance_to_rest(simulation), 1e-4);
}

TEST(DefaultStep, GravityThatComesAtOnceHangsTheBeamWhereItRests) {
  BeamOptions options;
  options.gravity = {0.0, 0.0, -9.81};
  options.young_modulus = 2e4;
  Simulation simulation(beam(options));
  for (int k = 0; k < 2; ++k) simulation.step();
  EXPECT_EQ(simulation.report().status, run::StepStatus::solved);
  EXPECT_LT(distance_to_rest(simulation), 1e-6);
}

// Number of iterations of a step, whether it converges or not.
int count_iterations(Simulation& simulation) {
  int iterations = 0;
  simulation.watch([&](const run::StepProgress& step) { iterations = step.iterations; });
  try {
    simulation.step();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::not_converged);
  }
  simulation.watch({});
  return iterations;
}

// A cable that folds the beam; docs/solver.md states the bound on the longest search.
TEST(DefaultStep, TheSearchForWhatIsNotThereEnds) {
  BeamOptions options;
  options.young_modulus = 2e4;
  for (const double force : {2.5, 5.0, 20.0}) {
    Simulation simulation(beam(options));
    simulation.command(0, tension(force));
    const int iterations = count_iterations(simulation);
    EXPECT_GT(iterations, 50) << force;
    EXPECT_LE(iterations, 1135 + 325 + 200 * 12) << force;
  }
}

// If the previous step ended far out of balance, this step stops with Newton's method and does not
// search further.
TEST(DefaultStep, AStepFromFarOutOfBalanceIsNotSearchedForLong) {
  BeamOptions options;
  options.young_modulus = 2e4;
  options.step.max_iterations = 5;
  Simulation simulation(beam(options));
  simulation.command(0, pull(0.03));
  run::State lost = simulation.state();
  EXPECT_GT(count_iterations(simulation), 5);
  EXPECT_EQ(simulation.report().status, run::StepStatus::solved);
  lost.residual = 0.5;
  simulation.restore(lost);
  EXPECT_EQ(count_iterations(simulation), 5);
  EXPECT_EQ(simulation.report().status, run::StepStatus::not_in_equilibrium);
}

TEST(DefaultStep, AStepAtRestTakesOneIteration) {
  Simulation simulation(beam());
  simulation.command(0, tension(0.5));
  for (int k = 0; k < 5; ++k) simulation.step();
  EXPECT_EQ(simulation.report().iterations, 1);
  EXPECT_LT(simulation.report().relative_residual, 1e-9);
}

TEST(DefaultStep, OneLinearisationSaysThatItLeftEquilibrium) {
  BeamOptions options;
  options.step.method = model::Method::one_linearisation;
  options.step.tangent = mechanics::Tangent::corotated;
  options.geometric_stiffness = false;
  Simulation simulation(beam(options));
  simulation.command(0, {model::CommandKind::motion, model::Signal::ramp({0.0, 0.06, 0.0, 0.5})});
  bool flagged = false;
  try {
    for (int k = 0; k < 80; ++k) flagged = is_flagged(simulation.step().status) || flagged;
  } catch (const Error& error) {
    flagged = error.is_run_failure();
  }
  EXPECT_TRUE(flagged);
}

// A swing gains energy with one linearisation per step about its start, and the status reports it;
// solved steps do not gain energy.
TEST(DefaultStep, ASwingKeepsItsEnergyOrSaysThatItDoesNot) {
  for (const auto integrator : {mechanics::Integrator::backward_euler, mechanics::Integrator::bdf2,
                                mechanics::Integrator::generalized_alpha}) {
    for (const model::Method method : {model::Method::newton, model::Method::one_linearisation}) {
      BeamOptions options;
      options.gravity = {0.0, 0.0, -9.81};
      options.young_modulus = 3e4;
      options.step.integrator = integrator;
      options.step.method = method;
      if (method == model::Method::one_linearisation) {
        options.step.tangent = mechanics::Tangent::corotated;
      }
      Simulation simulation(beam(options));
      const double start = simulation.energies().strain + simulation.energies().gravity;
      double gained = 0.0, swing = 0.0;
      bool flagged = false;
      try {
        for (int k = 0; k < 200; ++k) {
          flagged = simulation.step().status == run::StepStatus::gaining_energy || flagged;
          const auto [strain, kinetic, gravity] = simulation.energies();
          gained = std::max(gained, strain + kinetic + gravity - start);
          swing = std::max(swing, kinetic + strain);
        }
      } catch (const Error& error) {
        flagged = error.is_run_failure();
      }
      EXPECT_TRUE(flagged || gained < 0.06 * swing)
          << mechanics::integrator_name(integrator) << " " << gained / swing;
      if (method == model::Method::one_linearisation) continue;
      EXPECT_FALSE(flagged);
      EXPECT_LT(gained, 0.01 * swing);
    }
  }
}

BeamOptions swinging() {
  BeamOptions options;
  options.gravity = {0.0, 0.0, -9.81};
  options.young_modulus = 3e4;
  options.step.integrator = mechanics::Integrator::backward_euler;
  return options;
}

// The reference energy of the check is part of the state, so a restored run continues unchanged.
TEST(DefaultStep, TheWatchOfEnergyGoesWithTheState) {
  const auto model = beam(swinging());
  Simulation run(model), loaded(model);
  for (int k = 0; k < 10; ++k) run.step();
  run::State state = run.state();
  for (int k = 0; k < 30; ++k) run.step();
  const double gained = run.report().energy_gained;
  EXPECT_LT(gained, 0.0);  // backward Euler damps
  for (Simulation* back : {&loaded, &run}) {
    back->restore(state);
    for (int k = 0; k < 30; ++k) EXPECT_EQ(back->step().status, run::StepStatus::solved);
    EXPECT_EQ(back->report().energy_gained, gained);
    EXPECT_EQ(back->ledger().dissipated, run.ledger().dissipated);
  }
}

// Energy that a static solution takes from gravity and commands does not count as gained by a step.
TEST(DefaultStep, AStaticSolutionGainsNoEnergy) {
  Simulation simulation(beam(swinging()));
  for (int k = 0; k < 3; ++k) simulation.step();
  simulation.command(0, tension(0.3));
  simulation.solve_static();
  for (int k = 0; k < 10; ++k) EXPECT_EQ(simulation.step().status, run::StepStatus::solved) << k;
  EXPECT_NEAR(simulation.report().energy_gained, 0.0, 1e-9);
  for (const double newtons : {0.4, 0.2}) {  // one stores more than the above equilibrium
    simulation.command(0, tension(newtons));
    simulation.follow_path({});
    for (int k = 0; k < 10; ++k) EXPECT_EQ(simulation.step().status, run::StepStatus::solved) << k;
    EXPECT_LT(simulation.report().energy_gained, 1e-9);
  }
  simulation.command(0, tension(0.0));
  simulation.solve_static();
  simulation.command(0, tension(0.3));
  for (int k = 0; k < 50; ++k) EXPECT_EQ(simulation.step().status, run::StepStatus::solved) << k;
}

TEST(DefaultStep, ARobotAtRestGainsNoEnergy) {
  for (const auto integrator : {mechanics::Integrator::backward_euler, mechanics::Integrator::bdf2,
                                mechanics::Integrator::generalized_alpha}) {
    BeamOptions options;
    options.step.integrator = integrator;
    Simulation run(beam(options));
    for (int k = 0; k < 20; ++k) EXPECT_EQ(run.step().status, run::StepStatus::solved) << k;
  }
}

TEST(DefaultStep, ReusedAssemblyDoesNotChangeABit) {
  BeamOptions options;
  const auto model = beam(options);
  Simulation whole(model), halves(model);
  for (Simulation* one : {&whole, &halves}) one->command(0, pull(0.003));
  for (int k = 0; k < 6; ++k) whole.step();
  for (int k = 0; k < 6; ++k) {
    halves.step();
    halves.restore(halves.state());
    halves.energies();
  }
  EXPECT_EQ(whole.state().hash(), halves.state().hash());
}

}  // namespace
}  // namespace sinew::sim
