// Response of effectors and actuators to a controller's efforts.
#include "sinew/sim/controlled_response.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/linearisation.hpp"
#include "sinew/sim/simulation.hpp"

#include "robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::beam;
using sinew::testing::tension;

model::Command length(double metres) {
  return {model::CommandKind::motion, model::Signal::constant(metres)};
}

// Two cables are controlled; the others keep their commanded tensions.
TEST(ControlledResponse, OfEffortsIsTheCompliance) {
  Simulation simulation(beam());
  for (int k = 0; k < 4; ++k) simulation.command(k, tension(1.0 + k));
  simulation.solve_static();
  const run::State before = simulation.state();
  const std::vector<int> controlled{2, 0};
  const ControlledResponse response = controlled_response(simulation, controlled);
  EXPECT_EQ(simulation.state(), before);

  const MatrixX w = linearise(simulation).compliance;
  ASSERT_EQ(response.effectors.size(), 1U);
  const std::vector<int> tip{4, 5, 6};
  EXPECT_LT((response.effectors[0] - w(tip, controlled)).norm(), 1e-12 * w.norm());
  EXPECT_LT((response.actuators - w(controlled, controlled)).norm(), 1e-12 * w.norm());
}

// Held lengths change the response to W_cc - W_ch W_hh^-1 W_hc.
TEST(ControlledResponse, HeldLengthsStay) {
  Simulation simulation(beam());
  for (int k = 0; k < 4; ++k) simulation.command(k, tension(2.0));
  simulation.solve_static();
  for (int k = 1; k < 4; ++k) simulation.command(k, length(simulation.actuator(k).motion));
  simulation.solve_static();
  const std::vector<int> controlled{0}, held{1, 2, 3}, tip{4, 5, 6};
  const ControlledResponse response = controlled_response(simulation, controlled);

  const MatrixX w = linearise(simulation).compliance;
  const MatrixX efforts = -w(held, held).ldlt().solve(w(held, controlled));
  const MatrixX moved = w(tip, controlled) + w(tip, held) * efforts;
  EXPECT_LT((response.effectors[0] - moved).norm(), 1e-9 * w.norm());
  const MatrixX own = w(controlled, controlled) + w(controlled, held) * efforts;
  EXPECT_LT((response.actuators - own).norm(), 1e-9 * w.norm());
  EXPECT_GT((w(tip, controlled) - moved).norm(), 1e-3 * moved.norm());
}

TEST(ControlledResponse, SaysThatNothingHoldsABody) {
  sinew::testing::BeamOptions loose;
  loose.clamped = false;
  loose.step.integrator = mechanics::Integrator::backward_euler;
  loose.step.time_step = 1e-3;
  Simulation simulation(beam(loose));
  const std::vector<int> controlled{0};
  try {
    controlled_response(simulation, controlled);
    FAIL() << "a loose beam has no compliance";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::singular_matrix);
  }
  LinearisationChoice dynamics;
  dynamics.of_statics = false;
  EXPECT_GT(controlled_response(simulation, controlled, dynamics).actuators(0, 0), 0.0);
}

}  // namespace
}  // namespace sinew::sim
