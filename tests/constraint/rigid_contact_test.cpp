#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/shape_contact.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/model/model.hpp"
#include "sinew/rigid/rigid_body_model.hpp"
#include "sinew/rigid/rigid_settings.hpp"
#include "sinew/rigid/shape.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::constraint {
namespace {

struct Pair {
  rigid::Shape first, second;
  double height = 0.0;  // of the first body's centre, m
};

std::vector<Pair> pairs() {
  const rigid::Box box{{0.04, 0.03, 0.02}};
  const rigid::Sphere ball{0.01};
  const rigid::Capsule capsule{0.01, 0.04};
  const rigid::Cylinder roller{0.01, 0.04};
  return {{box, box, 0.0205},
          {ball, box, 0.0202},
          {capsule, box, 0.041},
          {roller, ball, 0.0303},
          {ball, ball, 0.0204}};
}

std::shared_ptr<const model::Model> make(const Pair& pair) {
  builder::ModelBuilder builder(
      model::StepSettings{.integrator = mechanics::Integrator::backward_euler});
  for (const bool first : {true, false}) {
    rigid::RigidSettings body;
    body.name = first ? "first" : "second";
    body.shape = first ? pair.first : pair.second;
    body.density = 1000.0;
    if (first) body.position = Vector3(0.003, -0.002, pair.height);
    builder.add_body<rigid::RigidBodyModel>(body);
  }
  builder::ContactSettings contact;
  contact.name = "touch";
  contact.body = 0;
  contact.touched = 1;
  contact.friction = 0.5;
  builder.add_contact(contact);
  return builder.build();
}

// Moves a body by a translation (m) and a rotation vector (rad).
void move(mechanics::Body& body, const Vector3& by, const Vector3& turn) {
  std::vector<double> state(body.state_size());
  body.save_state(state);
  for (int k = 0; k < 3; ++k) state[static_cast<std::size_t>(k)] += by[k];
  Eigen::Map<Eigen::Quaterniond> rotation(state.data() + 3);
  if (turn.norm() > 0.0) {
    rotation = Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * rotation;
  }
  body.load_state(state);
}

TEST(RigidContact, RowsAreTheDerivativeOfGapAndSlip) {
  for (const Pair& pair : pairs()) {
    const auto model = make(pair);
    sim::Simulation simulation(model);
    const Configuration& configuration = simulation.configuration();
    move(simulation.body(0), Vector3(0.001, 0.0, 0.0), Vector3(0.01, 0.02, 0.3));
    const auto& contact = dynamic_cast<const ShapeContact&>(model->contact(0));
    mechanics::RowValues values;
    values.resize(model->rows());
    const auto pose = contact.carrier()->pose(configuration);
    contact.begin_step(configuration, pose, pose, 0.0, values);
    contact.linearise(configuration, values);
    const mechanics::RowValues before = values;
    const Vector3 v[] = {Vector3(0.3, -0.5, 0.2), Vector3(-0.1, 0.4, 0.6)};
    const Vector3 w[] = {Vector3(3.0, 7.0, -4.0), Vector3(-6.0, 2.0, 5.0)};
    constexpr double kSmall = 1e-7;
    for (int body = 0; body < 2; ++body) {
      move(simulation.body(body), kSmall * v[body], kSmall * w[body]);
    }
    contact.linearise(configuration, values);
    ASSERT_FALSE(contact.idle(0, values));
    for (std::size_t k = 0; k < contact.size(); ++k) {
      if (contact.idle(k, values)) continue;
      for (int j = 0; j < 3; ++j) {
        const Vector3* direction = &before.direction[contact.entry(k, j)];
        const double rate = direction[0].dot(v[0]) + direction[1].dot(w[0]) +
                            direction[2].dot(v[1]) + direction[3].dot(w[1]);
        const int row = contact.row(k) + j;
        EXPECT_NEAR((values.delta[row] - before.delta[row]) / kSmall, rate, 1e-5)
            << "point " << k << ", row " << j;
      }
    }
  }
}

// The action of a contact on two bodies has no resultant: forces and moments about any point
// cancel.
TEST(RigidContact, ForcesCancel) {
  for (const Pair& pair : pairs()) {
    const auto model = make(pair);
    sim::Simulation simulation(model);
    const Configuration& configuration = simulation.configuration();
    const auto& contact = dynamic_cast<const ShapeContact&>(model->contact(0));
    mechanics::RowValues values;
    values.resize(model->rows());
    const auto pose = contact.carrier()->pose(configuration);
    contact.begin_step(configuration, pose, pose, 0.0, values);
    const Vector3 centre[] = {configuration.position(contact.own()->centre),
                              configuration.position(contact.carrier()->centre)};
    ASSERT_FALSE(contact.idle(0, values));
    for (std::size_t k = 0; k < contact.size(); ++k) {
      if (contact.idle(k, values)) continue;  // has no force
      for (int j = 0; j < 3; ++j) {
        const Vector3* direction = &values.direction[contact.entry(k, j)];
        EXPECT_EQ(direction[0], -direction[2]);
        const Vector3 moment = direction[1] + direction[3] + centre[0].cross(direction[0]) +
                               centre[1].cross(direction[2]);
        EXPECT_LT(moment.norm(), 1e-15) << "point " << k << ", row " << j;
      }
    }
  }
}

// A ball that rolls keeps its gap, whatever angle it turns by.
TEST(RigidContact, RollingKeepsTheGap) {
  const auto model = make({rigid::Sphere{0.01}, rigid::Box{{0.4, 0.3, 0.02}}, 0.0202});
  sim::Simulation simulation(model);
  const auto& contact = dynamic_cast<const ShapeContact&>(model->contact(0));
  mechanics::RowValues values;
  values.resize(model->rows());
  const auto pose = contact.carrier()->pose(simulation.configuration());
  contact.begin_step(simulation.configuration(), pose, pose, 0.0, values);
  move(simulation.body(0), Vector3(0.005, 0.0, 0.0), Vector3(0.0, 0.5, 0.0));
  contact.linearise(simulation.configuration(), values);
  EXPECT_NEAR(values.delta[contact.row(0)], 0.0002, 1e-15);
}

}  // namespace
}  // namespace sinew::constraint
