// Simulation of arms: orders of integrators, energy, stiffness of the lumped model, equilibria.
#include "sinew/pcc/arm_simulation.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"

#include "arms.hpp"

namespace sinew::pcc {
namespace {

using mechanics::Integrator;
using testing::fluidic;
using testing::make;

/// An undamped arm with distributed mass, which is not stiff.
std::shared_ptr<const Arm> lossless() {
  ArmSettings settings = fluidic(MassCentre::distributed);
  for (Segment& segment : settings.segments) segment.damping = 0.0;
  return make(settings);
}

/// Position after half a second of swinging from a bent pose.
VectorX swing(const std::shared_ptr<const Arm>& arm, Integrator integrator, double step) {
  ArmSimulation simulation(
      arm,
      {.time_step = step, .integrator = integrator, .spectral_radius = 1.0, .tolerance = 1e-12});
  simulation.set_state(VectorX{{0.2, 0.15, 0.1, 0.1}}, VectorX::Zero(4));
  const auto steps = static_cast<int>(std::lround(0.3 / step));
  for (int i = 0; i < steps; ++i) simulation.step(VectorX::Zero(4));
  return simulation.position();
}

TEST(ArmSimulation, ConvergesWithTheIntegratorsOrder) {
  ArmSettings settings = fluidic(MassCentre::distributed);
  const auto arm = make(settings);
  for (const auto& [integrator, order] :
       {std::pair(Integrator::backward_euler, 1.0), std::pair(Integrator::bdf2, 2.0),
        std::pair(Integrator::generalized_alpha, 2.0)}) {
    const double h = order > 1.0 ? 5e-4 : 2.5e-4;
    const VectorX reference = swing(arm, Integrator::generalized_alpha, 2.5e-5);
    const double coarse = (swing(arm, integrator, 2.0 * h) - reference).norm();
    const double fine = (swing(arm, integrator, h) - reference).norm();
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.3) << integrator_name(integrator);
  }
}

TEST(ArmSimulation, EnergyDriftsWithTheSquareOfTheStep) {
  const auto drift = [&](double step) {
    ArmSimulation simulation(lossless(), {.time_step = step,
                                          .integrator = Integrator::generalized_alpha,
                                          .spectral_radius = 1.0,
                                          .tolerance = 1e-12});
    simulation.set_state(VectorX{{0.2, 0.15, 0.1, 0.1}}, VectorX::Zero(4));
    auto& equations = simulation.equations();
    const double before = equations.energy(simulation.position(), simulation.rate()).total();
    double most = 0.0;
    for (double end = 0.3 - 0.5 * step; simulation.time() < end;) {
      simulation.step(VectorX::Zero(4));
      most = std::max(
          most,
          std::abs(equations.energy(simulation.position(), simulation.rate()).total() - before));
    }
    return most;
  };
  const double coarse = drift(5e-4), fine = drift(2.5e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.4);
  EXPECT_LT(fine, 1e-3);
}

TEST(ArmSimulation, LumpedMassesAreStiffAndExplicitStepsBlowUp) {
  const auto arm = make(fluidic());
  ArmEquations equations(arm);
  const double lowest =
      linalg::symmetric_eigenvalues(equations.mass_matrix(VectorX::Constant(4, 0.1)))[0];
  EXPECT_GT(4.2e-3 / lowest, 1e3);  // 1/s
  const double step = 1e-3;
  // Explicit: q' += h q'', q += h q' (symplectic Euler).
  VectorX q = VectorX::Constant(4, 0.1), rate = VectorX::Zero(4);
  bool blown = false;
  for (int i = 0; i < 100 && !blown; ++i) {
    rate += step * equations.acceleration(q, rate, VectorX::Zero(4));
    q += step * rate;
    blown = !(q.norm() < 1e3);
  }
  EXPECT_TRUE(blown);
  ArmSimulation simulation(arm, {.time_step = step, .integrator = Integrator::backward_euler});
  simulation.set_state(VectorX::Constant(4, 0.1), VectorX::Zero(4));
  for (int i = 0; i < 4000; ++i) simulation.step(VectorX::Zero(4));
  EXPECT_LT(simulation.position().norm(), 0.5 * 0.2);  // a start of 0.2, lightly damped
}

TEST(ArmSimulation, SettlesWhereTheEquilibriumIs) {
  ArmSettings settings = testing::mixed();
  for (Segment& segment : settings.segments) segment.damping = 0.05;
  const auto arm = make(settings);
  const VectorX torque = 0.05 * VectorX::LinSpaced(arm->coordinates(), -1.0, 1.0);
  ArmSimulation simulation(arm, {.time_step = 5e-3, .integrator = Integrator::backward_euler});
  for (int i = 0; i < 4000; ++i) simulation.step(torque);
  const auto rest =
      find_equilibrium(simulation.equations(), torque, VectorX::Zero(arm->coordinates()));
  EXPECT_TRUE(rest.stable);
  EXPECT_LT((rest.position - simulation.position()).norm(), 1e-6);
  const VectorX still = VectorX::Zero(arm->coordinates());
  EXPECT_LT((simulation.equations().residual(rest.position, still, still) - torque).norm(), 1e-11);
}

TEST(ArmSimulation, SettingsOutOfRangeAreErrors) {
  const auto arm = make(fluidic());
  EXPECT_THROW(ArmSimulation(arm, {.time_step = 0.0}), Error);
  EXPECT_THROW(ArmSimulation(arm, {.spectral_radius = 1.5}), Error);
  EXPECT_THROW(ArmSimulation(arm, {.integrator = Integrator::quasi_static}), Error);
}

}  // namespace
}  // namespace sinew::pcc
