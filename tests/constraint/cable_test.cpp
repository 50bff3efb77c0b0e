#include "sinew/constraint/cable.hpp"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/builder/cable_settings.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

#include "../sim/robots.hpp"

namespace sinew::constraint {
namespace {

// A bent beam, where nothing is aligned by accident.
class BentCable : public ::testing::Test {
 protected:
  BentCable() : model_(sinew::testing::beam()), simulation_(model_) {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0.0, 1e-3);
    Points& forces = mechanics::as<mechanics::TakesForces>(simulation_.body(0))->external_forces();
    for (Eigen::Index i = 0; i < forces.size(); ++i) forces.data()[i] = 5.0 * noise(random);
    simulation_.solve_static();
  }
  mechanics::Body& body() { return simulation_.body(0); }
  const Cable& cable() { return *model_->cable(0); }
  // Displaces all nodes by t times a fixed random direction.
  void shift(double t) {
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0.0, 1.0);
    std::vector<double> state(body().state_size());
    body().save_state(state);
    for (std::size_t i = 0; i < state.size() / 2; ++i) state[i] += t * noise(random);
    body().load_state(state);
  }
  // Sum over the cable's entries of direction . d(point)/dt.
  double directional(const mechanics::RowValues& rows, const Points& before, const Points& after,
                     double t) {
    double sum = 0.0;
    for (int e = 0; e < 5; ++e) {  // the world pull point has no entry
      sum += rows.direction[static_cast<std::size_t>(e)].dot(
          (after.row(e + 1) - before.row(e + 1)).transpose() / t);
    }
    return sum;
  }

  std::shared_ptr<const model::Model> model_;
  sim::Simulation simulation_;
};

TEST_F(BentCable, DirectionsAreTheDerivativeOfTheMotion) {
  const double t = 1e-6;
  auto& world = simulation_.world();
  const Points middle = cable().points(simulation_.configuration());
  world.measure_delta();
  const mechanics::RowValues rows = world.rows();
  shift(t);
  const double ahead = world.measure_delta()[0];
  const Points after = cable().points(simulation_.configuration());
  shift(-2 * t);
  const double behind = world.measure_delta()[0];
  const double difference = (ahead - behind) / (2 * t);
  EXPECT_NEAR(directional(rows, middle, after, t), difference, 1e-6 * std::abs(difference));
}

TEST_F(BentCable, HessianIsTheDerivativeOfTheDirections) {
  const double t = 1e-6;
  auto& world = simulation_.world();
  std::vector<mechanics::StiffnessPair> pairs(
      model_->stiffness_pairs().begin(),
      model_->stiffness_pairs().begin() + cable().stiffness_pair_count());
  const std::vector<double> effort{1.0};
  cable().geometric_stiffness(simulation_.configuration(), effort, pairs);
  const Points middle = cable().points(simulation_.configuration());
  shift(t);
  const Points after = cable().points(simulation_.configuration());
  world.measure_delta();
  const auto ahead = world.rows().direction;
  shift(-2 * t);
  world.measure_delta();
  const auto behind = world.rows().direction;
  const Points velocity = (after - middle) / t;
  for (int point = 0; point < 5; ++point) {
    Vector3 expected = Vector3::Zero();
    for (const auto& pair : pairs) {
      const int first = pair.first.number - pairs[0].first.number;
      const int second = pair.second.number - pairs[0].first.number;
      if (first == point) expected += pair.hessian * velocity.row(second + 1).transpose();
      if (second == point && first != second) {
        expected += pair.hessian.transpose() * velocity.row(first + 1).transpose();
      }
    }
    const auto e = static_cast<std::size_t>(point);
    const Vector3 difference = (ahead[e] - behind[e]) / (2 * t);
    EXPECT_LT((expected - difference).norm(), 1e-5 * (1.0 + difference.norm())) << point;
  }
}

// The directions of each row are the derivatives of its motion, and the Hessian is that of H^T
// lambda.
TEST(CableFriction, RowsAndHessianAgreeWithDifferences) {
  const auto model = sinew::testing::beam({.cables = 1, .pull_from_world = false, .friction = 0.2});
  sim::Simulation simulation(model);
  auto& body = simulation.body(0);
  auto& world = simulation.world();
  const Cable& cable = *model->cable(0);
  ASSERT_EQ(cable.row_count(), 1 + cable.via_count());
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 1e-3);
  std::vector<double> state(body.state_size()), velocity(state.size(), 0.0);
  body.save_state(state);
  for (std::size_t i = 0; i < state.size() / 2; ++i) {
    state[i] += noise(random);
    velocity[i] = 1e3 * noise(random);
  }
  const auto at = [&](double t) {
    auto moved = state;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += t * velocity[i];
    body.load_state(moved);
    world.measure_delta();
    return std::pair(world.rows(), cable.points(simulation.configuration()));
  };
  const double t = 1e-6;
  const auto [ahead, after] = at(t);
  const auto [behind, before] = at(-t);
  const auto [rows, here] = at(0.0);
  const Points rates = (after - before) / (2.0 * t);
  std::vector<double> effort(static_cast<std::size_t>(model->rows().rows()), 0.0);
  for (int k = 0; k < cable.row_count(); ++k) effort[static_cast<std::size_t>(k)] = 3.0 - 0.4 * k;
  const int first_point = model->rows().site[0].number;
  Points slope = Points::Zero(here.rows(), 3), expected = slope;
  for (int k = 0; k < cable.row_count(); ++k) {
    double rate = 0.0;
    for (auto e = model->rows().row_start[static_cast<std::size_t>(k)];
         e < model->rows().row_start[static_cast<std::size_t>(k) + 1]; ++e) {
      const auto entry = static_cast<std::size_t>(e);
      const auto point = model->rows().site[entry].number - first_point;
      rate += rows.direction[entry].dot(rates.row(point));
      slope.row(point) += effort[static_cast<std::size_t>(k)] *
                          (ahead.direction[entry] - behind.direction[entry]).transpose() /
                          (2.0 * t);
    }
    const double difference = (ahead.delta[k] - behind.delta[k]) / (2.0 * t);
    EXPECT_NEAR(rate, difference, 1e-7 * (1.0 + std::abs(difference))) << k;
  }
  std::vector<mechanics::StiffnessPair> pairs(
      model->stiffness_pairs().begin(),
      model->stiffness_pairs().begin() + cable.stiffness_pair_count());
  cable.geometric_stiffness(simulation.configuration(), effort, pairs);
  for (const auto& pair : pairs) {
    const int a = pair.first.number - first_point, b = pair.second.number - first_point;
    expected.row(a) += (pair.hessian * rates.row(b).transpose()).transpose();
    if (a != b)
      expected.row(b) += (pair.hessian.transpose() * rates.row(a).transpose()).transpose();
  }
  EXPECT_LT((slope - expected).cwiseAbs().maxCoeff(), 1e-5 * slope.cwiseAbs().maxCoeff());
}

TEST_F(BentCable, MotionIsTheLengthPulledOut) {
  const auto& configuration = simulation_.configuration();
  EXPECT_NEAR(simulation_.world().measure_delta()[0],
              cable().rest_length() - cable().length(configuration), 1e-15);
}

TEST(Cable, StraightCableHasNoWrapAndARightAngleHasOne) {
  const auto model = sinew::testing::beam();
  sim::Simulation simulation(model);
  EXPECT_NEAR(model->cable(0)->wrap(simulation.configuration()), 0.0, 1e-12);

  builder::ModelBuilder builder;
  fem::FemBodySettings body;
  body.name = "block";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.size = {0.1, 0.1, 0.1}, .cells = {2, 2, 2}}));
  body.mesh = mesh;
  body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::CableSettings cable;
  cable.name = "corner";
  cable.points.resize(3, 3);
  cable.points << 0.01, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.09;
  builder.add_cable(cable);
  const auto corner = builder.build();
  sim::Simulation bent(corner);
  EXPECT_NEAR(corner->cable(0)->wrap(bent.configuration()), sinew::testing::kRightAngle, 1e-12);
  EXPECT_NEAR(corner->cable(0)->rest_length(), 0.08, 1e-15);
}

ErrorKind kind_of(const builder::CableSettings& cable) {
  builder::ModelBuilder builder;
  fem::FemBodySettings body;
  body.name = "block";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.size = {0.1, 0.1, 0.1}, .cells = {2, 2, 2}}));
  body.mesh = mesh;
  body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  builder.add_body<fem::FemBodyModel>(std::move(body));
  try {
    builder.add_cable(cable);
  } catch (const Error& error) {
    EXPECT_FALSE(error.remedy().empty());
    return error.kind();
  }
  return ErrorKind::internal;
}

TEST(Cable, DefectsAreErrorsAtLoad) {
  builder::CableSettings cable;
  cable.name = "bad";
  cable.points.resize(1, 3);
  cable.points << 0.01, 0.05, 0.05;
  EXPECT_EQ(kind_of(cable), ErrorKind::too_few_points);
  cable.points.resize(3, 3);
  cable.points << 0.01, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05;
  EXPECT_EQ(kind_of(cable), ErrorKind::degenerate_cable);
  cable.points.row(2) << 0.05, 0.05, 0.2;
  EXPECT_EQ(kind_of(cable), ErrorKind::point_outside_mesh);
  cable.points.row(2) << 0.05, 0.05, 0.09;
  cable.tension = {.min = 3.0, .max = 2.0};
  EXPECT_EQ(kind_of(cable), ErrorKind::contradictory_limits);
  cable.tension = {.min = -1.0};
  EXPECT_EQ(kind_of(cable), ErrorKind::out_of_range);
}

}  // namespace
}  // namespace sinew::constraint
