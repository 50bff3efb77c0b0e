// A kind of body that the library does not know, beside those that it knows.
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/builder/force_settings.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/state_io.hpp"

#include "../toys/spring_point.hpp"
#include "robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::SpringPointModel;
using sinew::testing::SpringPointSettings;

constexpr double kSag = 0.1 * 9.81 / 50.0;  // m, of the point

struct Options {
  model::StepSettings step{.time_step = 1e-3, .integrator = mechanics::Integrator::backward_euler};
  double height = 1.0;         // m, of the point above the floor; no floor if not finite
  bool with_beam = false;      // a cantilever of finite elements
  bool with_effector = false;  // on the point
};

std::shared_ptr<const model::Model> robot(const Options& options) {
  builder::ModelBuilder builder(options.step);
  SpringPointSettings settings;
  settings.at.z() = options.height;
  const int point = builder.add_body<SpringPointModel>(settings);
  builder::ForceSettings push;
  push.name = "push";
  push.body = point;
  push.point.z() = options.height;
  push.direction = Vector3::UnitX();
  builder.add_force(push);
  if (options.with_beam) {
    fem::FemBodySettings body;
    body.name = "beam";
    const auto mesh = std::make_shared<const mesh::Mesh>(mesh::block(
        {.corner = {0.02, -0.01, 0.99}, .size = {0.1, 0.02, 0.02}, .cells = {6, 2, 2}}));
    body.mesh = mesh;
    body.gravity = {0.0, 0.0, -9.81};
    body.elements.regions = {{{200e3, 0.4}, material::Law::corotational, 1070.0, {}}};
    body.elements.fixed_nodes = mesh->node_sets.at("x_min");
    const int beam = builder.add_body<fem::FemBodyModel>(std::move(body));
    builder::CableSettings cable;  // from the point to the tip of the beam
    cable.name = "cable";
    cable.points.resize(2, 3);
    cable.points << 0.0, 0.0, 1.0, 0.12, 0.0, 1.0;
    cable.point_bodies = {point, beam};
    cable.pull_from_world = false;
    cable.tension = {0.0, 2.0};
    builder.add_cable(cable);
  }
  if (options.with_effector) {
    builder::EffectorSettings effector;
    effector.name = "place";
    effector.body = point;
    effector.points = push.point.transpose();
    builder.add_effector(effector);
  }
  if (options.height < 0.5) {
    builder::ContactSettings floor;
    floor.name = "floor";
    floor.body = point;
    floor.points = push.point.transpose();
    floor.surface = collision::Plane{};
    floor.friction = 0.5;
    builder.add_contact(floor);
  }
  return builder.build();
}

TEST(OwnBody, SagsUnderItsWeight) {
  Simulation simulation(robot({.step = {.integrator = mechanics::Integrator::quasi_static}}));
  simulation.solve_static();
  EXPECT_NEAR(simulation.body(0).position(0).z(), 1.0 - kSag, 1e-12);
  EXPECT_NEAR(simulation.energies().strain, 0.5 * 50.0 * kSag * kSag, 1e-12);
}

// What a body holds by itself counts as held however far it lies from the origin.
TEST(OwnBody, IsHeldFarFromTheOrigin) {
  for (const double height : {1.0, 1e2, 1e4, 1e6}) {
    const auto model =
        robot({.step = {.integrator = mechanics::Integrator::quasi_static}, .height = height});
    EXPECT_FALSE(model->is_loose()) << height;
  }
}

TEST(OwnBody, SwingsInEveryIntegrator) {
  using enum mechanics::Integrator;
  for (const auto integrator : {bdf2, generalized_alpha, event_driven}) {
    Simulation simulation(robot({.step = {.time_step = 1e-3, .integrator = integrator}}));
    for (int k = 0; k < 100; ++k) simulation.step();
    const double swung = kSag * (1.0 - std::cos(std::sqrt(50.0 / 0.1) * 0.1));
    EXPECT_NEAR(simulation.body(0).position(0).z(), 1.0 - swung, 2e-3 * kSag)
        << mechanics::integrator_name(integrator);
  }
}

// It is pressed to the floor by a part of its weight, sticks while it is pushed by less than mu
// times that, and slides to where the spring holds it then.
TEST(OwnBody, TouchesWithFriction) {
  const double height = 0.5 * kSag, pressed = 0.5 * 0.1 * 9.81;
  Simulation simulation(robot({.height = height}));
  for (int k = 0; k < 2000; ++k) simulation.step();
  EXPECT_NEAR(simulation.contacts().resultant(0).normal_force, pressed, 1e-6);
  simulation.command(
      0, model::Command{model::CommandKind::effort, model::Signal::constant(0.4 * pressed)});
  for (int k = 0; k < 1000; ++k) simulation.step();
  EXPECT_LT(std::abs(simulation.body(0).position(0).x()), 1e-6);
  simulation.command(
      0, model::Command{model::CommandKind::effort, model::Signal::constant(2.0 * pressed)});
  for (int k = 0; k < 4000; ++k) simulation.step();
  const double held = 50.0 * simulation.body(0).position(0).x();
  EXPECT_GT(held, 1.4 * pressed);
  EXPECT_LT(held, 2.51 * pressed);
}

TEST(OwnBody, HasObservablesAndStates) {
  const auto model = robot({.with_beam = true, .with_effector = true});
  Simulation simulation(model), other(model);
  Observables list(simulation);
  EXPECT_EQ(list.list()[list.find("point.positions")].shape, (std::vector<std::size_t>{1, 3}));
  simulation.command(1, model::Command{model::CommandKind::effort, model::Signal::constant(1.0)});
  for (int k = 0; k < 30; ++k) simulation.step();
  list.refresh();
  EXPECT_EQ(list.read(list.find("place.position"))[0], simulation.body(0).position(0).x());
  EXPECT_GT(simulation.body(0).position(0).x(), 1e-3) << "the cable pulls it to the beam";
  other.command(1, model::Command{model::CommandKind::effort, model::Signal::constant(1.0)});
  parse_state(other, format_state(simulation), "state");
  const auto clone = simulation.clone();
  for (int k = 0; k < 30; ++k) {
    simulation.step();
    other.step();
    clone->step();
  }
  EXPECT_EQ(other.state(), simulation.state());
  EXPECT_EQ(clone->state(), simulation.state());
}

TEST(OwnBody, RefusesWhatNeedsAMesh) {
  const auto model = robot({});
  EXPECT_FALSE(model->body(0).has_mesh());
  const auto kind_of = [](auto&& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(kind_of([&] { model->body(0).mesh(); }), ErrorKind::wrong_type);
  builder::ModelBuilder builder;
  const int point = builder.add_body<SpringPointModel>(SpringPointSettings{});
  builder::ContactSettings touch;
  touch.name = "touch";
  touch.body = touch.touched.emplace(point);
  EXPECT_EQ(kind_of([&] { builder.add_contact(touch); }), ErrorKind::not_in_this_version);
}

TEST(OwnBody, NeedsMassInDynamics) {
  builder::ModelBuilder builder({.time_step = 1e-3, .integrator = mechanics::Integrator::bdf2});
  try {
    builder.add_body<SpringPointModel>(SpringPointSettings{.mass = 0.0});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::missing_mass);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("body 'point'"));
  }
}

}  // namespace
}  // namespace sinew::sim
