#include "sinew/sim/linear_model.hpp"

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/linearisation.hpp"
#include "sinew/sim/state_io.hpp"

#include "../toys/spring_point.hpp"
#include "robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::beam;

MatrixX dense(const LinearModel::Matrix& matrix) { return matrix; }

TEST(LinearModel, OfAPointOnASpring) {
  builder::ModelBuilder builder;
  builder.add_body<sinew::testing::SpringPointModel>(sinew::testing::SpringPointSettings{});
  Simulation simulation(builder.build());
  const LinearModel linear = linear_model(simulation);
  EXPECT_LT((dense(linear.mass) - 0.1 * MatrixX::Identity(3, 3)).norm(), 1e-14);
  EXPECT_LT((dense(linear.stiffness) - 50.0 * MatrixX::Identity(3, 3)).norm(), 1e-10);
  EXPECT_EQ(linear.damping.nonZeros(), 0);
  EXPECT_NEAR(linear.imbalance.z(), -0.981, 1e-12) << "its weight";
}

// The compliance of linearise() is C K^-1 B, by another way: the factorised matrix and its border.
TEST(LinearModel, ItsStiffnessIsThatOfTheCompliance) {
  sinew::testing::BeamOptions options;
  options.geometric_stiffness = true;
  options.tension = {0.0, 5.0};
  Simulation simulation(beam(options));
  simulation.command(0, {model::CommandKind::effort, model::Signal::constant(1.0)});
  for (int k = 0; k < 3; ++k) simulation.step();
  const run::State before = simulation.state();
  const LinearModel linear = linear_model(simulation);
  EXPECT_TRUE(simulation.state() == before);
  const Linearisation other = linearise(simulation);
  const MatrixX stiffness = dense(linear.stiffness);
  EXPECT_LT((stiffness - stiffness.transpose()).norm(), 1e-10 * stiffness.norm());
  linalg::LuFactor factor(stiffness.rows());
  factor.compute(stiffness);
  MatrixX moved(stiffness.rows(), linear.input.cols());
  factor.solve_columns(linear.input, moved);
  const MatrixX response = linear.output * moved;
  const Eigen::Index inputs = linear.input.cols();
  const MatrixX expected = other.compliance.block(inputs, 0, response.rows(), inputs);
  EXPECT_LT((response - expected).norm(), 1e-7 * expected.norm());
  EXPECT_EQ(linear.outputs.front(), other.rows[static_cast<std::size_t>(inputs)]);
  EXPECT_LT(linear.imbalance.norm(), 1e-4);
}

TEST(LinearModel, MassAndRayleighDamping) {
  for (const auto mass : {fem::MassMatrix::lumped, fem::MassMatrix::consistent}) {
    sinew::testing::BeamOptions options;
    options.mass = mass;
    options.damping = {.mass = 0.3, .stiffness = 2e-3};
    options.step.integrator = mechanics::Integrator::bdf2;
    Simulation simulation(beam(options));
    const LinearModel linear = linear_model(simulation);
    const VectorX motion = VectorX::LinSpaced(linear.mass.rows(), -1.0, 1.0);
    VectorX inertia(motion.size());
    simulation.body(0).system().apply_mass(
        {motion.data(), static_cast<std::size_t>(motion.size())},
        {inertia.data(), static_cast<std::size_t>(motion.size())});
    EXPECT_LT((linear.mass * motion - inertia).norm(), 1e-9 * inertia.norm());
    const MatrixX expected = 0.3 * dense(linear.mass) + 2e-3 * dense(linear.stiffness);
    EXPECT_LT((dense(linear.damping) - expected).norm(), 1e-8 * expected.norm());
  }
}

// A column under a dead load loses its stiffness across at Euler's load.
TEST(LinearModel, StiffnessIsThatOfTheLoadedState) {
  sinew::testing::BeamOptions options;
  options.cables = 4;
  options.pull_from_world = false;  // along the body: they press it
  options.geometric_stiffness = true;
  options.tension = {0.0, 50.0};
  Simulation slack(beam(options)), pressed(beam(options));
  for (int k = 0; k < 4; ++k) {
    pressed.command(k, {model::CommandKind::effort, model::Signal::constant(2.0)});
  }
  pressed.solve_static();
  const MatrixX before = dense(linear_model(slack).stiffness);
  const MatrixX after = dense(linear_model(pressed).stiffness);
  EXPECT_GT((after - before).norm(), 1e-3 * before.norm());
}

}  // namespace
}  // namespace sinew::sim
