// Node displacements per unit effort of each row, and the linearisation of the last step.
#include "sinew/sim/linearisation.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/controlled_response.hpp"
#include "sinew/sim/simulation.hpp"

#include "cut_beam.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::cut_beam;
using sinew::testing::CutBeam;

constexpr double kStep = 1e-4;  // N

// Row displacements per force on one node of the second part, from differences of equilibria.
VectorX by_differences(Simulation& simulation, NodeId node, const Vector3& force) {
  auto* second = mechanics::as<mechanics::TakesForces>(simulation.body(1));
  const auto motions = [&](double scale) {
    second->external_forces().row(node) = scale * force.transpose();
    simulation.solve_static({.tolerance = 1e-12});
    return linearise(simulation).delta;
  };
  const VectorX result = (motions(kStep) - motions(-kStep)) / (2.0 * kStep);
  second->external_forces().setZero();
  simulation.solve_static({.tolerance = 1e-12});
  return result;
}

// The columns must include the response of the welds' efforts.
TEST(Fields, AreTheRowsAnswersToForcesOnNodesThroughWelds) {
  CutBeam options{.gravity = {0.0, 0.0, -2.0}, .cables = 1, .push = true};
  Simulation simulation(cut_beam(options));
  simulation.command(0, {model::CommandKind::effort, model::Signal::constant(2.0)});
  simulation.solve_static({.tolerance = 1e-12});
  const Linearisation linear = linearise(simulation, {.fields = true});
  ASSERT_EQ(linear.fields.size(), 2U);
  ASSERT_EQ(linear.fields[1].size(), linear.rows.size());
  const NodeId node = static_cast<NodeId>(linear.fields[1][0].rows() - 1);
  const Vector3 force{0.3, -0.5, 0.8};
  const VectorX expected = by_differences(simulation, node, force);
  VectorX found(expected.size());
  for (Eigen::Index row = 0; row < found.size(); ++row) {
    found[row] = linear.fields[1][static_cast<std::size_t>(row)].row(node).dot(force);
  }
  EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm());
}

TEST(Fields, AreEmptyUnlessAskedFor) {
  Simulation simulation(cut_beam({.cables = 1, .push = true}));
  EXPECT_TRUE(linearise(simulation).fields.empty());
}

TEST(LastLinearisation, IsThatOfTheStepAndNeedsOne) {
  CutBeam options{.gravity = {0.0, 0.0, -2.0}, .cables = 1, .push = true};
  Simulation simulation(cut_beam(options));
  simulation.command(0, {model::CommandKind::effort, model::Signal::constant(2.0)});
  simulation.solve_static({.tolerance = 1e-12});
  const Linearisation last = last_linearisation(simulation);
  const Linearisation here = linearise(simulation);
  EXPECT_EQ(last.rows, here.rows);
  EXPECT_TRUE(std::isnan(last.residual));
  EXPECT_LT((last.compliance - here.compliance).norm(), 1e-6 * here.compliance.norm());
  EXPECT_LT((last.delta - here.delta).norm(), 1e-12 * here.delta.norm());
}

void expect_same(const Linearisation& one, const Linearisation& other) {
  EXPECT_EQ(one.rows, other.rows);
  EXPECT_EQ(one.compliance, other.compliance);
  EXPECT_EQ(one.delta, other.delta);
  EXPECT_EQ(one.delta_free, other.delta_free);
  EXPECT_EQ(one.effort, other.effort);
  EXPECT_EQ(one.negative_pivots, other.negative_pivots);
}

// The static W is far from that of a step, so an overwrite by a query would show.
TEST(LastLinearisation, StaysThatOfTheStepAfterQueries) {
  Simulation simulation(cut_beam({.gravity = {0.0, 0.0, -2.0}, .cables = 1, .push = true}));
  simulation.command(0, {model::CommandKind::effort, model::Signal::constant(2.0)});
  simulation.step();
  const Linearisation last = last_linearisation(simulation);
  const Linearisation statics = linearise(simulation);
  EXPECT_GT((statics.compliance - last.compliance).norm(), 1e-3 * last.compliance.norm());
  expect_same(last_linearisation(simulation), last);
  linearise(simulation, {.every_point = true});
  expect_same(last_linearisation(simulation), last);
  controlled_response(simulation, std::vector<int>{0});
  expect_same(last_linearisation(simulation), last);
}

TEST(LastLinearisation, IsRefusedWhereNoStepLedToTheState) {
  Simulation simulation(cut_beam({.gravity = {0.0, 0.0, -2.0}, .cables = 1, .push = true}));
  const auto expect_refused = [&] {
    EXPECT_THROW(last_linearisation(simulation), Error);
    linearise(simulation);
    EXPECT_THROW(last_linearisation(simulation), Error) << "a query is no step";
  };
  expect_refused();
  simulation.step();
  const run::State state = simulation.state();
  simulation.step();
  EXPECT_NO_THROW(last_linearisation(simulation));
  simulation.restore(state);
  expect_refused();
  simulation.step();
  EXPECT_NO_THROW(last_linearisation(simulation));
  simulation.reset();
  expect_refused();
}

}  // namespace
}  // namespace sinew::sim
