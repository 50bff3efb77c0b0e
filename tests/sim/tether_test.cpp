// Spring of a hand on a robot, and fields of a deformed robot.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/fem/element_fields.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "robots.hpp"

namespace sinew {
namespace {

mechanics::TakesForces& pulled(sim::Simulation& simulation) {
  return *mechanics::as<mechanics::TakesForces>(simulation.body(0));
}

// A tether on the first tetrahedron face at the beam's free end.
mechanics::Tether end_tether(const mesh::Mesh& mesh, double stiffness, const Vector3& anchor) {
  const double end = mesh.nodes.col(0).maxCoeff();
  for (const auto& tetrahedron : mesh.tetrahedra) {
    std::vector<NodeId> face;
    for (const NodeId node : tetrahedron) {
      if (mesh.nodes(node, 0) > end - 1e-9) face.push_back(node);
    }
    if (face.size() == 3) {
      return {{face[0], face[1], face[2]}, {0.5, 0.3, 0.2}, anchor, stiffness};
    }
  }
  ADD_FAILURE() << "no face at the end";
  return {};
}

TEST(Tether, HoldsTheBodyAsTheSameForceWould) {
  const auto model = testing::beam();
  sim::Simulation held(model), pushed(model);
  const auto tether = end_tether(held.body(0).model().mesh(), 30.0, {0.09, 0.01, 0.05});
  pulled(held).set_tether(tether);
  held.solve_static();
  const Vector3 force = tether.stiffness * (tether.anchor - pulled(held).tether_point());
  EXPECT_GT(force.norm(), 0.05);
  for (std::size_t k = 0; k < 3; ++k) {
    pulled(pushed).external_forces().row(tether.nodes[k]) = tether.weights[k] * force.transpose();
  }
  pushed.solve_static();
  const double difference =
      (held.body(0).positions() - pushed.body(0).positions()).cwiseAbs().maxCoeff();
  EXPECT_LT(difference, 1e-9);
}

// Applied explicitly, a spring stiffer than the robot would make its motion grow without bound.
TEST(Tether, MayBeFarStifferThanTheRobot) {
  sim::Simulation simulation(testing::beam());
  mechanics::TakesForces& body = pulled(simulation);
  const Vector3 anchor(0.095, 0.0, 0.03);
  body.set_tether(end_tether(simulation.body(0).model().mesh(), 1e6, anchor));
  simulation.step();
  EXPECT_LT((body.tether_point() - anchor).norm(), 1e-5);
  for (int k = 0; k < 100; ++k) simulation.step();
  EXPECT_LT((body.tether_point() - anchor).norm(), 1e-5);
  EXPECT_LT(simulation.report().relative_residual, 1e-6);
}

TEST(Tether, LetsGoWithoutATrace) {
  sim::Simulation simulation(testing::beam());
  const mechanics::Body& body = simulation.body(0);
  const auto at_rest = simulation.state().hash();
  pulled(simulation).set_tether(end_tether(body.model().mesh(), 100.0, {0.1, 0.0, 0.05}));
  for (int k = 0; k < 20; ++k) simulation.step();
  EXPECT_GT((body.positions() - body.model().mesh().nodes).cwiseAbs().maxCoeff(), 1e-3);
  pulled(simulation).set_tether(std::nullopt);
  for (int k = 0; k < 60; ++k) simulation.step();
  EXPECT_LT((body.positions() - body.model().mesh().nodes).cwiseAbs().maxCoeff(), 1e-12);
  simulation.reset();
  EXPECT_EQ(simulation.state().hash(), at_rest);
}

TEST(Tether, RefusesWhatIsNoFace) {
  sim::Simulation simulation(testing::beam());
  mechanics::TakesForces& body = pulled(simulation);
  const auto good = end_tether(simulation.body(0).model().mesh(), 1.0, Vector3::Zero());
  const auto expect = [&](auto&& change, ErrorKind kind) {
    mechanics::Tether tether = good;
    change(tether);
    try {
      body.set_tether(tether);
      ADD_FAILURE() << "accepted; expected " << error_kind_name(kind);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
    }
    EXPECT_FALSE(body.tether().has_value());
  };
  expect([](mechanics::Tether& t) { t.nodes[1] = -1; }, ErrorKind::index_out_of_range);
  expect([](mechanics::Tether& t) { t.nodes[1] = 1 << 20; }, ErrorKind::index_out_of_range);
  expect([](mechanics::Tether& t) { t.nodes[1] = t.nodes[0]; }, ErrorKind::bad_argument);
  expect([](mechanics::Tether& t) { t.weights[0] = 0.7; }, ErrorKind::out_of_range);
  expect([](mechanics::Tether& t) { t.stiffness = -1.0; }, ErrorKind::out_of_range);
  expect([](mechanics::Tether& t) { t.anchor[2] = std::numeric_limits<double>::quiet_NaN(); },
         ErrorKind::not_finite);
}

TEST(ElementFields, CableForceIsWhatTheCablePutsOnTheBody) {
  sim::Simulation simulation(testing::beam());
  simulation.command(0, testing::tension(2.0));
  simulation.step();
  const mechanics::Body& body = simulation.body(0);
  const auto& material = *mechanics::as<const fem::HasMaterial>(body);
  const auto force = fem::row_force_field(material, simulation.efforts());
  Points sum = Points::Zero(body.positions().rows(), 3);
  material.add_row_forces(simulation.efforts(), sum);
  // A straight cable along x, from the clamp to its anchor near the tip, pulls the tip towards the
  // clamp.
  const Vector3 total = sum.colwise().sum();
  EXPECT_NEAR(total.x(), -2.0, 0.05);
  EXPECT_NEAR(total.norm(), 2.0, 1e-9);  // balanced by the pull point
  EXPECT_GT(*std::ranges::max_element(force), 0.1);
  const auto moved = fem::displacement_field(body);
  EXPECT_GT(*std::ranges::max_element(moved), 1e-4);
}

}  // namespace
}  // namespace sinew
