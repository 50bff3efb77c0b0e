#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "robots.hpp"

namespace sinew::sim {
namespace {

using mechanics::Integrator;
using sinew::testing::beam;
using sinew::testing::BeamOptions;

BeamOptions falling(Integrator integrator, double step, double rho = 0.8) {
  BeamOptions options;
  options.step.integrator = integrator;
  options.step.time_step = step;
  options.step.spectral_radius = rho;
  options.step.method = model::Method::newton;
  options.step.tangent = mechanics::Tangent::exact;
  options.step.tolerance = 1e-10;
  options.gravity = {0.0, 0.0, -9.81};
  options.cables = 0;
  return options;
}

Vector3 tip_after(const BeamOptions& options, double duration) {
  Simulation simulation(beam(options));
  const auto steps = std::lround(duration / options.step.time_step);
  for (long i = 0; i < steps; ++i) simulation.step();
  return simulation.effector_value(0);
}

// (30,): the tip at ten times, since an error at one time may happen to be small.
VectorX tips_until(const BeamOptions& options, double duration) {
  Simulation simulation(beam(options));
  const auto steps = std::lround(0.1 * duration / options.step.time_step);
  VectorX tips(30);
  for (Eigen::Index k = 0; k < 10; ++k) {
    for (long i = 0; i < steps; ++i) simulation.step();
    tips.segment<3>(3 * k) = simulation.effector_value(0);
  }
  return tips;
}

// The error against a run with much smaller steps decreases as h or h^2.
TEST(Integrator, OrdersAreAsPublished) {
  constexpr double kEnd = 0.04;
  for (const bool damped : {false, true}) {
    const auto options = [&](Integrator integrator, double step, double rho) {
      BeamOptions result = falling(integrator, step, rho);
      if (damped) result.damping = {1.0, 2e-4};
      return result;
    };
    const VectorX exact = tips_until(options(Integrator::generalized_alpha, 1.25e-5, 1.0), kEnd);
    struct Expected {
      Integrator integrator;
      double rho, order;
    };
    for (const auto& [integrator, rho, order] :
         {Expected{Integrator::backward_euler, 0.0, 1.0}, Expected{Integrator::bdf2, 0.0, 2.0},
          Expected{Integrator::generalized_alpha, 0.0, 2.0},
          Expected{Integrator::generalized_alpha, 0.8, 2.0},
          Expected{Integrator::generalized_alpha, 1.0, 2.0}}) {
      std::vector<double> errors;
      for (const double step : {4e-4, 2e-4}) {
        const double scale =
            order == 1.0 ? 0.125 : 0.25;  // the first order appears at smaller steps
        errors.push_back((tips_until(options(integrator, scale * step, rho), kEnd) - exact).norm());
      }
      const double found = std::log2(errors[0] / errors[1]);
      EXPECT_NEAR(found, order, 0.3)
          << mechanics::integrator_name(integrator) << " " << rho << ", damped " << damped;
    }
  }
}

double energy(Simulation& simulation) {
  const mechanics::Energies now = simulation.energies();
  return now.strain + now.kinetic + now.gravity;
}

TEST(Integrator, TheSpectralRadiusIsAKnobForDamping) {
  double before = 1e300;
  for (const double rho : {0.0, 0.5, 0.8, 1.0}) {
    Simulation simulation(beam(falling(Integrator::generalized_alpha, 2e-3, rho)));
    double swing = 0.0;
    for (int i = 0; i < 250; ++i) {
      simulation.step();
      swing = std::max(swing, simulation.energies().kinetic);
    }
    const double lost = -energy(simulation) / swing;  // from rest, with zero energy
    EXPECT_LT(lost, before) << rho;
    if (rho == 1.0) {
      EXPECT_LT(std::abs(lost), 0.02);
    } else {
      EXPECT_GT(lost, 0.0);
    }
    before = lost;
  }
}

TEST(Integrator, SavedStatesGoOnBitForBit) {
  for (const auto integrator : {Integrator::bdf2, Integrator::generalized_alpha}) {
    Simulation a(beam(falling(integrator, 2e-3))), b(beam(falling(integrator, 2e-3)));
    for (int i = 0; i < 20; ++i) a.step();
    run::State state = a.state();
    b.restore(state);
    for (int i = 0; i < 20; ++i) {
      a.step();
      b.step();
    }
    EXPECT_EQ(a.state().hash(), b.state().hash());
    a.reset();
    Simulation fresh(beam(falling(integrator, 2e-3)));
    for (int i = 0; i < 5; ++i) {
      a.step();
      fresh.step();
    }
    EXPECT_EQ(a.state().hash(), fresh.state().hash());
  }
}

// One linearisation per step with damping: the matrix contains the damping, and its force at the
// start of the step uses the velocity that the integrator carries over.
TEST(Integrator, OneLinearisationConvergesToTheSameMotion) {
  for (const auto integrator : {Integrator::bdf2, Integrator::generalized_alpha}) {
    BeamOptions options = falling(integrator, 2.5e-4);
    options.damping = {1.0, 2e-3};
    const Vector3 newton = tip_after(options, 0.1);
    options.step.method = model::Method::one_linearisation;
    options.step.tangent = mechanics::Tangent::corotated;
    const Vector3 once = tip_after(options, 0.1);
    EXPECT_LT((once - newton).norm(), 2e-5) << mechanics::integrator_name(integrator);
  }
}

TEST(Adaptive, MeetsItsToleranceWithFewerSteps) {
  const Vector3 exact = tip_after(falling(Integrator::generalized_alpha, 5e-5, 1.0), 0.1);
  double last_error = 1.0;
  int last_steps = 0;
  for (const double tolerance : {1e-3, 1e-5}) {
    BeamOptions options = falling(Integrator::generalized_alpha, 0.02);
    options.step.adaptive = model::AdaptiveStep{tolerance, 1e-5};
    Simulation simulation(beam(options));
    int substeps = 0;
    for (int i = 0; i < 5; ++i) {
      const run::StepReport& report = simulation.step();
      substeps += report.substeps;
      EXPECT_LE(report.error, tolerance * simulation.model().size());
    }
    EXPECT_DOUBLE_EQ(simulation.time(), 0.1);
    const double error = (simulation.effector_value(0) - exact).norm();
    EXPECT_LT(error, 0.3 * last_error);
    EXPECT_GT(substeps, last_steps);
    EXPECT_LT(substeps, 1000);
    last_error = error;
    last_steps = substeps;
  }
  EXPECT_LT(last_error, 2e-4);
}

TEST(Adaptive, RetriesWhereAStepFails) {
  const auto pulled = [](bool adaptive) {
    BeamOptions options = falling(Integrator::backward_euler, 0.05);
    options.cables = 4;
    options.step.max_iterations = 3;
    if (adaptive) options.step.adaptive = model::AdaptiveStep{1.0, 1e-4};
    auto simulation = std::make_unique<Simulation>(beam(options));
    simulation->command(0,
                        {model::CommandKind::motion, model::Signal::ramp({0.0, 0.01, 0.0, 0.05})});
    return simulation;
  };
  EXPECT_THROW(pulled(false)->step(), Error);
  const auto simulation = pulled(true);
  const run::StepReport& report = simulation->step();
  EXPECT_GT(report.retries, 0);
  EXPECT_GT(report.substeps, 1);
  EXPECT_NEAR(simulation->actuator(0).motion, 0.01, 1e-9);
}

// The next step does not repeat a failed step length, and a saved state remembers it.
TEST(Parts, TheNextStepBeginsWithPartsOfTheLastOnes) {
  BeamOptions options = falling(Integrator::backward_euler, 0.05);
  options.cables = 4;
  options.step.max_iterations = 4;
  Simulation simulation(beam(options));
  simulation.command(0, {model::CommandKind::motion, model::Signal::ramp({0.0, 0.02, 0.0, 0.1})});
  const run::StepReport first = simulation.step();
  EXPECT_GT(first.retries, 0);
  EXPECT_EQ(first.substeps, 4);  // quarters, since halves failed
  const run::State saved = simulation.state();
  const run::StepReport second = simulation.step();
  EXPECT_EQ(second.retries, 0);
  EXPECT_EQ(second.substeps, 4);
  EXPECT_NEAR(simulation.actuator(0).motion, 0.02, 1e-9);

  Simulation other(simulation.shared_model());
  other.command(0, {model::CommandKind::motion, model::Signal::ramp({0.0, 0.02, 0.0, 0.1})});
  other.restore(saved);
  EXPECT_EQ(other.step().substeps, second.substeps);
  EXPECT_EQ(other.state().hash(), simulation.state().hash());

  // At rest, whole steps succeed again.
  int substeps = 0;
  for (int k = 0; k < 40; ++k) substeps = simulation.step().substeps;
  EXPECT_EQ(substeps, 1);
}

TEST(Adaptive, StopsAtTheSmallestStepAndRestoresTheState) {
  BeamOptions options = falling(Integrator::backward_euler, 0.05);
  options.cables = 4;
  options.step.max_iterations = 1;
  options.step.tolerance = 1e-15;
  options.step.adaptive = model::AdaptiveStep{1.0, 0.01};
  Simulation simulation(beam(options));
  const auto before = simulation.state().hash();
  EXPECT_THROW(simulation.step(), Error);
  EXPECT_EQ(simulation.steps(), 0);
  EXPECT_NE(simulation.state().hash(), 0U);
  Simulation fresh(beam(options));
  EXPECT_EQ(fresh.state().hash(), before);
  EXPECT_EQ(simulation.body(0).positions(), fresh.body(0).positions());
}

}  // namespace
}  // namespace sinew::sim
