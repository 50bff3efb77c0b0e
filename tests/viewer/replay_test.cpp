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

TEST(Replay, AnotherArmsAnglesAreRefused) {
  RobotState run = state_of(kArm), replay = state_of(kArm);
  RecordedState recorded = moment(run);
  recorded.coordinates[0] = VectorX::Zero(3);
  EXPECT_THROW(replay.show(recorded), Error);
}

}  // namespace
}  // namespace sinew::viewer
