// Constant-curvature arms as bodies: the same motion as the arm alone, cables, control, states.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/cable_settings.hpp"
#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/force_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/builder/torque_settings.hpp"
#include "sinew/constraint/smooth_surface.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/thread_pool.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/pcc/arm_simulation.hpp"
#include "sinew/pcc/has_arm.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "pcc/arms.hpp"

namespace sinew::sim {
namespace {

using pcc::ArmSettings;
using pcc::MassCentre;
using pcc::testing::fluidic;
using pcc::testing::mixed;

model::Command hold(double effort) {
  return {model::CommandKind::effort, model::Signal::constant(effort)};
}

builder::TorqueSettings torque(int segment, double value) {
  builder::TorqueSettings settings;
  settings.name = "torque_" + std::to_string(segment);
  settings.segment = segment;
  settings.command = hold(value);
  return settings;
}

const VectorX& coordinates(const Simulation& simulation) {
  return mechanics::as<const mechanics::HasCoordinates>(simulation.body(0))->coordinates();
}

/// The fluidic arm with torques on its last three segments.
std::shared_ptr<const model::Model> driven(const model::StepSettings& step, MassCentre centre) {
  builder::ModelBuilder builder(step);
  builder.add_body<pcc::ArmBodyModel>(fluidic(centre));
  builder.add_torque(torque(1, 0.05));
  builder.add_torque(torque(2, -0.04));
  builder.add_torque(torque(3, 0.1));
  return builder.build();
}

const VectorX kTorque{{0.0, 0.05, -0.04, 0.1}};

TEST(ArmBody, MovesAsTheArmByItself) {
  for (const auto integrator : {mechanics::Integrator::backward_euler, mechanics::Integrator::bdf2,
                                mechanics::Integrator::generalized_alpha}) {
    model::StepSettings step;
    step.time_step = 2e-3;
    step.integrator = integrator;
    step.method = model::Method::newton;
    step.tolerance = 1e-12;
    Simulation simulation(driven(step, MassCentre::arc));
    pcc::ArmSimulation alone(pcc::testing::make(fluidic(MassCentre::arc)),
                             {.time_step = 2e-3, .integrator = integrator, .tolerance = 1e-12});
    for (int i = 0; i < 200; ++i) {
      simulation.step();
      alone.step(kTorque);
    }
    EXPECT_GT(alone.position().norm(), 0.1);
    EXPECT_LT((coordinates(simulation) - alone.position()).norm(), 1e-8)
        << integrator_name(integrator);
  }
}

/// The fluidic arm with commanded bends in all segments, and a wall at x = far for points along it.
std::shared_ptr<const model::Model> commanded(const model::StepSettings& step, double angle,
                                              double far, double friction) {
  builder::ModelBuilder builder(step);
  builder.add_body<pcc::ArmBodyModel>(fluidic(MassCentre::arc));
  for (int segment = 0; segment < 4; ++segment) {
    builder::TorqueSettings bend = torque(segment, 0.0);
    bend.command = {model::CommandKind::motion, model::Signal::constant(angle)};
    builder.add_torque(bend);
  }
  if (far > 0.0) {
    builder::ContactSettings wall;
    wall.name = "wall";
    wall.surface = collision::Plane{{far, 0.0, 0.0}, -Vector3::UnitX()};
    wall.points = Points::Zero(2, 3);
    wall.points(0, 2) = -0.2;
    wall.points(1, 2) = -0.4;
    wall.outside = mesh::Outside::nearest;
    wall.friction = friction;
    builder.add_contact(wall);
  }
  return builder.build();
}

// A jump of the angle makes the gyroscopic part of A large, which the law does not include.
TEST(ArmBody, NewtonReachesACommandedAngleInOneStep) {
  for (const auto integrator :
       {mechanics::Integrator::backward_euler, mechanics::Integrator::bdf2}) {
    model::StepSettings step;
    step.time_step = 5e-3;
    step.integrator = integrator;
    step.method = model::Method::newton;
    Simulation simulation(commanded(step, 0.1, 0.0, 0.0));
    for (int k = 0; k < 10; ++k) {
      simulation.step();
      ASSERT_EQ(simulation.report().newton, run::NewtonStatus::converged);
      for (int segment = 0; segment < 4; ++segment) {
        EXPECT_NEAR(simulation.actuator(segment).motion, 0.1, 1e-7);
      }
    }
  }
}

// With all bends held, the compliance of the contact points is mere rounding.
TEST(ArmBody, HeldBendsAreNoHindranceToOpenContacts) {
  for (const model::Method method : {model::Method::one_linearisation, model::Method::newton}) {
    for (const double friction : {0.0, 0.5}) {
      model::StepSettings step;
      step.integrator = mechanics::Integrator::quasi_static;
      step.method = method;
      Simulation simulation(commanded(step, 0.1, 1.0, friction));
      for (int k = 0; k < 5; ++k) simulation.step();
      EXPECT_NEAR(simulation.actuator(0).motion, 0.1, 1e-9);
      EXPECT_EQ(simulation.contacts().resultant(0).normal_force, 0.0);
      // If the commanded bends lead into the wall, no contact force can satisfy the law.
      Simulation blocked(commanded(step, 0.5, 0.05, friction));
      Simulation mirrored(commanded(step, -0.5, 0.05, friction));
      int failed = 0;
      for (Simulation* one : {&blocked, &mirrored}) {
        try {
          for (int k = 0; k < 5; ++k) one->step(OnFailure::keep_going);
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), ErrorKind::not_converged);
          ++failed;
        }
      }
      EXPECT_EQ(failed, 1);
    }
  }
}

TEST(ArmBody, SettlesInTheArmsEquilibrium) {
  model::StepSettings step;
  step.integrator = mechanics::Integrator::quasi_static;
  Simulation simulation(driven(step, MassCentre::distributed));
  simulation.solve_static();
  pcc::ArmEquations equations(pcc::testing::make(fluidic(MassCentre::distributed)));
  const auto rest = pcc::find_equilibrium(equations, kTorque, VectorX::Zero(4));
  EXPECT_LT((coordinates(simulation) - rest.position).norm(), 1e-8);
  EXPECT_NEAR(simulation.actuator(2).motion, rest.position[3], 1e-8);
}

TEST(ArmBody, CableDoesTheWorkOfItsLength) {
  // All features at once: rotated segments, dead lengths, extension. r(q) = -T dl/dq, with the
  // derivative of the length l by differences.
  model::StepSettings step;
  step.integrator = mechanics::Integrator::quasi_static;
  ArmSettings settings = mixed();
  const Vector3 along = settings.frame.col(2), across = settings.frame.col(0);
  builder::CableSettings cable;
  cable.name = "tendon";
  const double at[] = {0.0, 0.1, 0.2, 0.3, 0.4};
  cable.points.resize(5, 3);
  for (int i = 0; i < 5; ++i) {
    cable.points.row(i) = (settings.base + at[i] * along + 0.015 * across).transpose();
  }
  cable.command = hold(2.0);
  builder::ModelBuilder builder(step);
  builder.add_body<pcc::ArmBodyModel>(settings);
  builder.add_cable(cable);
  Simulation simulation(builder.build());
  simulation.solve_static();

  const auto& model = *mechanics::as<const pcc::HasArm>(simulation.body(0).model());
  pcc::ArmEquations equations(model.shared_arm());
  const VectorX q = coordinates(simulation), still = VectorX::Zero(q.size());
  EXPECT_GT(q.norm(), 0.05);
  pcc::ArmBodyModel places(model.shared_arm());
  ThreadPool pool;
  const auto length = [&](const VectorX& at_q) {
    const auto probe = places.create(pool, false, 0);
    mechanics::as<mechanics::HasCoordinates>(*probe)->set_coordinates(at_q, still);
    double sum = 0.0;
    Vector3 before = cable.points.row(0);
    for (int i = 0; i < 4; ++i) {
      const Vector3 next = probe->position(i);
      sum += (next - before).norm();
      before = next;
    }
    return sum;
  };
  for (int i = 1; i < 5; ++i) {
    places.attach(cable.points.row(i).transpose(), mesh::Outside::error, "point");
  }
  const VectorX r = equations.residual(q, still, still);
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    VectorX up = q, down = q;
    up[k] += 1e-6;
    down[k] -= 1e-6;
    EXPECT_NEAR(r[k], -2.0 * (length(up) - length(down)) / 2e-6, 1e-6 * (1.0 + r.norm())) << k;
  }
}

TEST(ArmBody, StateGoesOnAsItWas) {
  model::StepSettings step;
  step.time_step = 5e-3;
  step.integrator = mechanics::Integrator::generalized_alpha;
  Simulation first(driven(step, MassCentre::arc)), second(first.shared_model());
  for (int i = 0; i < 20; ++i) first.step();
  run::State state = first.state();
  second.restore(state);
  for (int i = 0; i < 20; ++i) {
    first.step();
    second.step();
  }
  EXPECT_EQ(first.state().hash(), second.state().hash());
}

TEST(ArmBody, LedgerBalancesOverASwing) {
  model::StepSettings step;
  step.time_step = 5e-4;
  step.integrator = mechanics::Integrator::generalized_alpha;
  step.spectral_radius = 1.0;
  step.method = model::Method::newton;
  step.tolerance = 1e-12;
  Simulation simulation(driven(step, MassCentre::distributed));
  for (int i = 0; i < 1000; ++i) simulation.step();
  const mechanics::Energies energies = simulation.energies();
  const double gained = energies.strain + energies.kinetic + energies.gravity;
  EXPECT_GT(simulation.ledger().actuators, 1e-3);
  EXPECT_NEAR(simulation.ledger().actuators - simulation.ledger().dissipated - gained, 0.0,
              1e-3 * simulation.ledger().actuators);
}

TEST(ArmBody, SkinFollowsTheAxis) {
  model::StepSettings step;
  step.integrator = mechanics::Integrator::quasi_static;
  Simulation simulation(driven(step, MassCentre::arc));
  const mesh::Mesh& skin = simulation.body(0).model().mesh();
  EXPECT_LT((simulation.body(0).positions() - skin.nodes).norm(), 1e-12);
  simulation.solve_static();
  const Points& moved = simulation.body(0).positions();
  EXPECT_GT((moved - skin.nodes).norm(), 0.1);
  EXPECT_TRUE(moved.allFinite());
}

TEST(ArmBody, ItsSurfaceHasAThickness) {
  const auto arm = std::make_shared<const pcc::Arm>(fluidic());
  pcc::ArmBodyModel model(arm);
  const auto beyond = [&](double share) {
    const Vector3 along = arm->settings().frame.col(2);
    return Vector3(arm->settings().base + (1.0 + share) * arm->length() * along);
  };
  const int point = model.attach(beyond(0.9e-5), mesh::Outside::error, "tip");
  EXPECT_LT((model.rest_position(point) - beyond(0.9e-5)).norm(), 1e-15);
  EXPECT_THROW(model.attach(beyond(1.1e-5), mesh::Outside::error, "tip"), Error);
}

TEST(ArmBody, WrongPartsAreErrors) {
  builder::ModelBuilder builder;
  builder.add_body<pcc::ArmBodyModel>(fluidic());
  const auto kind_of = [&](auto&& add) {
    try {
      add();
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(kind_of([&] { builder.add_torque(torque(4, 0.0)); }), ErrorKind::index_out_of_range);
  EXPECT_EQ(kind_of([&] {
              auto across = torque(1, 0.0);
              across.towards = builder::TorqueSettings::Towards::across;
              builder.add_torque(across);
            }),
            ErrorKind::unknown_choice);
  EXPECT_EQ(kind_of([&] {
              builder::ForceSettings force;
              force.name = "push";
              force.point = {0.1, 0.0, -0.2};
              builder.add_force(force);
            }),
            ErrorKind::point_outside_mesh);
}

}  // namespace
}  // namespace sinew::sim
