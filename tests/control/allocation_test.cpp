// In the steady state a step allocates nothing, controlled or not, on one thread or four.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/builder/cable_settings.hpp"
#include "sinew/builder/effector_settings.hpp"
#include "sinew/builder/torque_settings.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/control/inverse_controller.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/pcc/published.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/sim/simulation.hpp"

#include "../sim/contact_robots.hpp"
#include "../sim/robots.hpp"
#include "../support/allocation_guard.hpp"

namespace sinew::control {
namespace {

using sinew::testing::allocations;

TEST(Allocation, IsSeenByTheGuard) {
  if (!sinew::testing::counts_allocations()) return;
  long before = allocations();
  const std::vector<double> made(100, 1.0);
  EXPECT_GT(allocations(), before) << made.size();
  before = allocations();
  const VectorX aligned = VectorX::Zero(1000);
  EXPECT_GT(allocations(), before) << aligned.size();
  before = allocations();
  struct alignas(128) Wide {
    double value[16];
  };
  const auto wide = std::make_unique<Wide>();
  EXPECT_GT(allocations(), before) << wide->value[0];
}

class SteadyStep : public ::testing::TestWithParam<int> {
 protected:
  void expect_none(sinew::testing::BeamOptions options, bool steered) {
    options.factorisation.threads = GetParam();
    options.displacement = {.rate = 0.5};
    sim::Simulation simulation(sinew::testing::beam(options), GetParam());
    std::unique_ptr<InverseController> controller;
    if (steered) {
      const Target circle = Target::circle({Vector3(0.099, 0, 0), 0.004, Vector3::UnitX(), 0.5, 0});
      controller = std::make_unique<InverseController>(
          simulation, TargetSettings{.tasks = {{0, circle, {1.0}}}, .actuators = {}});
    } else {
      simulation.command(0,
                         {model::CommandKind::motion, model::Signal::sine({0.001, 0.001, 0.3, 0})});
      simulation.command(1, {model::CommandKind::effort, model::Signal::sine({0.1, 0.1, 0.4, 0})});
    }
    // Buffers grow when a step first needs them: the bound of a distance by a correction, for one.
    for (int i = 0; i < 100; ++i) simulation.step();
    const long before = allocations();
    for (int i = 0; i < 100; ++i) simulation.step();
    EXPECT_EQ(allocations(), before);
  }
};

TEST_P(SteadyStep, OfDirectQuasiStatics) { expect_none({}, false); }
TEST_P(SteadyStep, OfInverseQuasiStatics) { expect_none({}, true); }
TEST_P(SteadyStep, WithGeometricStiffness) {
  sinew::testing::BeamOptions options;
  options.geometric_stiffness = true;
  expect_none(options, true);
}
TEST_P(SteadyStep, OfDampedDynamics) {
  sinew::testing::BeamOptions options;
  options.step.integrator = mechanics::Integrator::backward_euler;
  options.damping = {.mass = 1.0, .stiffness = 0.01};
  expect_none(options, false);
}
TEST_P(SteadyStep, OfNewtonDynamics) {
  sinew::testing::BeamOptions options;
  options.step.integrator = mechanics::Integrator::backward_euler;
  options.step.method = model::Method::newton;
  options.step.tangent = mechanics::Tangent::exact;
  options.damping = {.mass = 1.0, .stiffness = 0.01};
  expect_none(options, false);
}

TEST_P(SteadyStep, OfContacts) {
  sinew::testing::BlockOptions options{.angle = 0.6, .height = 1e-4};
  for (const model::Method method : {model::Method::one_linearisation, model::Method::newton}) {
    options.step.method = method;
    options.factorisation.threads = GetParam();
    sim::Simulation simulation(sinew::testing::block_on_plane(options).build(), GetParam());
    const auto land = [&] {  // some points stick, others slide
      for (int i = 0; i < 103; ++i) simulation.step();
    };
    land();  // buffers grow to the number of contacts
    simulation.reset();
    const long before = allocations();
    land();
    EXPECT_EQ(allocations(), before);
    EXPECT_GT(simulation.contacts().resultant(0).normal_force, 0.0);
  }
}

// An arm with torques and a cable, commanded or controlled.
TEST_P(SteadyStep, OfConstantCurvatureArms) {
  for (const bool steered : {false, true}) {
    model::StepSettings step;
    step.time_step = 2e-3;
    step.integrator = mechanics::Integrator::generalized_alpha;
    step.method = model::Method::newton;
    builder::ModelBuilder builder(step);
    builder.add_body<pcc::ArmBodyModel>(pcc::published_arm(pcc::MassCentre::distributed));
    for (int segment = 1; segment < 4; ++segment) {
      builder::TorqueSettings torque;
      torque.name = "torque_" + std::to_string(segment);
      torque.segment = segment;
      torque.torque = {.min = -0.1, .max = 0.1};
      torque.command = {model::CommandKind::effort, model::Signal::sine({0.0, 0.05, 1.0, 0})};
      builder.add_torque(torque);
    }
    builder::CableSettings cable;
    cable.name = "tendon";
    cable.points.resize(3, 3);
    cable.points << 0.01, 0.0, -0.001, 0.01, 0.0, -0.2, 0.01, 0.0, -0.5;
    cable.geometric_stiffness = true;
    cable.tension = {.min = 0.0, .max = 2.0};
    cable.command = {model::CommandKind::effort, model::Signal::constant(0.5)};
    builder.add_cable(cable);
    builder::EffectorSettings tip;
    tip.name = "tip";
    tip.points = Points(Vector3(0.0, 0.0, -0.56).transpose());
    tip.directions = {Vector3::UnitX(), Vector3::UnitZ()};
    builder.add_effector(tip);
    sim::Simulation simulation(builder.build(), GetParam());
    std::unique_ptr<InverseController> controller;
    if (steered) {
      const Target circle =
          Target::circle({Vector3(0.0, 0.0, -0.54), 0.01, Vector3::UnitY(), 1.0, 0});
      controller = std::make_unique<InverseController>(
          simulation, TargetSettings{.tasks = {{0, circle, {1.0, 1.0}}}, .actuators = {}});
    }
    // Buffers grow when a step first needs them: the bound of a distance by a correction, for one.
    for (int i = 0; i < 100; ++i) simulation.step();
    const long before = allocations();
    for (int i = 0; i < 100; ++i) simulation.step();
    EXPECT_EQ(allocations(), before) << steered;
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, SteadyStep, ::testing::Values(1, 4));

}  // namespace
}  // namespace sinew::control
