// A moment of a recorded run is shown as it was: angles of arms, drives, integrators that keep
// more.
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/arm_body.hpp"

#include "robot_fixture.hpp"
#include "viewer/robot_state.hpp"

namespace sinew::viewer {
namespace {

constexpr const char* kArm = R"(sinew: 1
time_step: 2 ms
integrator: {type: generalized-alpha, spectral_radius: 0.8}
bodies:
  arm:
    type: pcc
    segments:
      - {length: 140 mm, mass: 190 g, stiffness: 0.108 N m, damping: 0.01 N m s}
      - {length: 140 mm, mass: 90 g, stiffness: 0.108 N m, damping: 0.01 N m s}
actuators:
  bend: {type: torque, body: arm, segment: 1, command: {torque: 0.05 N m}}
  pull: {type: cable, body: arm, points: [10 0 -1 mm, 10 0 -270 mm], command: {tension: 1 N}}
effectors:
  tip: {body: arm, point: 0 0 -280 mm}
)";

RecordedState moment(RobotState& state) {
  const sim::Simulation& simulation = state.simulation();
  RecordedState recorded;
  for (const auto& body : simulation.world().bodies()) {
    recorded.positions.push_back(body->positions());
    const auto* arm = dynamic_cast<const pcc::ArmBody*>(body.get());
    recorded.coordinates.push_back(arm == nullptr ? VectorX() : arm->coordinates());
  }
  for (std::size_t i = 0; i < simulation.model().actuators().size(); ++i) {
    recorded.efforts.push_back(simulation.actuator(static_cast<int>(i)).effort);
    recorded.motions.push_back(simulation.actuator(static_cast<int>(i)).motion);
  }
  recorded.step = simulation.steps();
  return recorded;
}

RobotState state_of(const char* text) {
  scene::Robot made = scene::build(scene::parse_scene_text(text, "test", {}));
  auto simulation = std::make_shared<sim::Simulation>(made.model);
  return {std::move(made), std::move(simulation), std::nullopt};
}

TEST(Replay, ShowsAnArmAsItWas) {
  RobotState run = state_of(kArm), replay = state_of(kArm);
  for (int i = 0; i < 50; ++i) run.step();
  replay.show(moment(run));
  const auto was = run.frame({}, 1.0), seen = replay.frame({}, 1.0);
  EXPECT_EQ(was->bodies[0].positions, seen->bodies[0].positions);
  EXPECT_EQ(was->effectors, seen->effectors);
  EXPECT_EQ(was->cables, seen->cables);
  EXPECT_EQ(was->step, seen->step);
  // Efforts, then motions, of both actuators.
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(was->signals[k], seen->signals[k]) << k;
  EXPECT_EQ(was->signals[1], 1.0);
}

constexpr const char* kFall = R"(sinew: 1
time_step: 2 ms
gravity: 0 0 -9.81 m/s^2
integrator: backward-euler
bodies:
  block:
    type: fem
    mesh: {shape: block, length: 20 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}
    material: {model: corotational, young_modulus: 100 kPa, poisson_ratio: 0.4}
    density: 1070 kg/m^3
contacts:
  floor:
    body: block
    surface: {plane: {normal: 0 0.1 1}}
    nodes: {set: z_min}
    friction: 0.5
    motion: {z: {ramp: {to: 2 mm, duration: 0.1 s}}, angle: {ramp: {to: 90 deg, duration: 0.1 s}}, axis: 0 0 1}
  roof:
    body: block
    surface: {sphere: {center: 10 10 30.5 mm, radius: 10 mm}}
    nodes: {set: z_max}
    friction: 0
)";

RecordedState moment_with_contacts(RobotState& state) {
  RecordedState recorded = moment(state);
  for (int c = 0; c < 2; ++c) recorded.contacts.push_back(state.simulation().contact_moment(c));
  return recorded;
}

TEST(Replay, ShowsContactsAsTheyWere) {
  RobotState run = state_of(kFall), replay = state_of(kFall);
  for (int i = 0; i < 30; ++i) run.step();
  replay.show(moment_with_contacts(run));
  const auto was = run.frame({}, 1.0), seen = replay.frame({}, 1.0);
  ASSERT_EQ(was->contacts.size(), 2U);
  ASSERT_EQ(was->contacts[0].size(), 7U * (1U + 9U));
  EXPECT_EQ(was->contacts, seen->contacts);
  const auto& list = run.description().signals;
  bool touches = false;
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (!list[k].key.starts_with("floor.") && !list[k].key.starts_with("roof.")) continue;
    EXPECT_EQ(was->signals[k], seen->signals[k]) << list[k].key;
    touches |= list[k].key == "floor.normal_force" && was->signals[k] > 0.0;
  }
  EXPECT_TRUE(touches);
  EXPECT_NEAR(was->contacts[0][2], 0.002 * 30 * 0.002 / 0.1, 1e-9);  // the floor has risen
  RecordedState short_of = moment_with_contacts(run);
  short_of.contacts[0].points.pop_back();
  EXPECT_THROW(replay.show(short_of), Error);
}

TEST(Replay, AnotherArmsAnglesAreRefused) {
  RobotState run = state_of(kArm), replay = state_of(kArm);
  RecordedState recorded = moment(run);
  recorded.coordinates[0] = VectorX::Zero(3);
  EXPECT_THROW(replay.show(recorded), Error);
}

}  // namespace
}  // namespace sinew::viewer
