// Derivatives of motions with respect to parameters and initial states.
#include "sinew/pcc/arm_sensitivity.hpp"

#include <gtest/gtest.h>

#include "arms.hpp"

namespace sinew::pcc {
namespace {

using mechanics::Integrator;
using testing::make;
using testing::mixed;

TEST(ArmEquations, MassRegressorIsTheDerivativeByMasses) {
  std::mt19937 random(4);
  for (const MassCentre centre : {MassCentre::arc, MassCentre::chord, MassCentre::distributed}) {
    const ArmSettings settings = mixed(centre);
    ArmEquations equations(make(settings));
    const Eigen::Index n = equations.arm().coordinates();
    const VectorX q = testing::random_vector(random, n, 0.8);
    const VectorX rate = testing::random_vector(random, n, 2.0);
    const VectorX acceleration = testing::random_vector(random, n, 20.0);
    const MatrixX found = equations.mass_regressor(q, rate, acceleration);
    for (int s = 0; s < 3; ++s) {
      // The residual is linear in the mass, so a difference of 1 kg is exact.
      ArmSettings heavier = settings;
      heavier.segments[static_cast<std::size_t>(s)].mass += 1.0;
      ArmEquations other(make(heavier));
      const VectorX slope =
          other.residual(q, rate, acceleration) - equations.residual(q, rate, acceleration);
      EXPECT_LT((slope - found.col(s)).cwiseAbs().maxCoeff(),
                1e-12 * slope.cwiseAbs().maxCoeff() + 1e-13);
    }
  }
}

TEST(ArmEquations, EndpointJacobianIsTheirDerivative) {
  ArmEquations equations(make(mixed()));
  std::mt19937 random(5);
  const VectorX q = testing::random_vector(random, 6, 0.8);
  const MatrixX found = equations.endpoint_jacobian(q);
  for (Eigen::Index k = 0; k < 6; ++k) {
    VectorX high = q, low = q;
    high[k] += 1e-6;
    low[k] -= 1e-6;
    const Points slope = (equations.endpoints(high) - equations.endpoints(low)) / 2e-6;
    EXPECT_LT((Eigen::Map<const VectorX>(slope.data(), 9) - found.col(k)).cwiseAbs().maxCoeff(),
              1e-9);
  }
}

/// The parameters are the mass of segment 1, all stiffness, all damping, the amplitude of a torque,
/// the first initial angle, and the second initial rate.
constexpr Eigen::Index kParameters = 6;

struct Run {
  VectorX q;
  MatrixX derivative;
};

Run run(const VectorX& p, Integrator integrator) {
  ArmSettings settings = mixed();
  settings.segments[1].mass = p[0];
  for (Segment& segment : settings.segments) {
    segment.stiffness *= p[1];
    segment.axial_stiffness *= p[1];
    segment.damping *= p[2];
    segment.axial_damping *= p[2];
  }
  const auto arm = make(settings);
  const Eigen::Index n = arm->coordinates();
  const VectorX shape = VectorX::LinSpaced(n, 0.01, 0.03);
  ArmSimulation simulation(
      arm,
      {.time_step = 2e-3, .integrator = integrator, .spectral_radius = 0.7, .tolerance = 1e-14});
  VectorX q = VectorX::LinSpaced(n, 0.1, 0.5), rate = VectorX::LinSpaced(n, -0.5, 0.5);
  q[n - 1] = 0.002;
  rate[n - 1] = 0.0;
  q[0] = p[4];
  rate[1] = p[5];
  simulation.set_state(q, rate);
  ArmSensitivity sensitivity(n, kParameters);
  MatrixX by_q = MatrixX::Zero(n, kParameters), by_rate = by_q, partial = by_q;
  by_q(0, 4) = by_rate(1, 5) = 1.0;
  sensitivity.start(by_q, by_rate);
  for (int i = 0; i < 60; ++i) {
    simulation.step(p[3] * shape);
    partial.col(0) =
        simulation.equations()
            .mass_regressor(simulation.position(), simulation.rate(), simulation.acceleration())
            .col(1);
    partial.col(1) = arm->stiffness().cwiseProduct(simulation.position()) / p[1];
    partial.col(2) = arm->damping().cwiseProduct(simulation.rate()) / p[2];
    partial.col(3) = -shape;
    sensitivity.follow(simulation, partial);
  }
  return {simulation.position(), sensitivity.position()};
}

TEST(ArmSensitivity, IsTheDerivativeOfTheSteps) {
  const VectorX p{{0.15, 1.1, 0.9, 1.3, 0.2, -0.4}};
  for (const Integrator integrator :
       {Integrator::backward_euler, Integrator::bdf2, Integrator::generalized_alpha}) {
    const MatrixX found = run(p, integrator).derivative;
    for (Eigen::Index k = 0; k < kParameters; ++k) {
      VectorX high = p, low = p;
      const double move = 1e-5 * std::abs(p[k]);
      high[k] += move;
      low[k] -= move;
      const VectorX slope = (run(high, integrator).q - run(low, integrator).q) / (2.0 * move);
      EXPECT_LT((slope - found.col(k)).cwiseAbs().maxCoeff(),
                2e-7 * slope.cwiseAbs().maxCoeff() + 1e-9)
          << mechanics::integrator_name(integrator) << " parameter " << k;
    }
  }
}

}  // namespace
}  // namespace sinew::pcc
