// Joints are drawn at their points on both bodies and along their axes.
#include "viewer/joint_marks.hpp"

#include <gtest/gtest.h>

#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/joint_load.hpp"

#include "robot_fixture.hpp"

namespace sinew::viewer {
namespace {

constexpr const char* kJoints = R"(sinew: 1
time_step: 1 ms
integrator: backward-euler
gravity: 0 0 -9.81 m/s^2
bodies:
  crank: {type: rigid, shape: {box: 50 8 5 mm}, mass: 20 g, pose: {position: 25 0 0 mm}}
  bob: {type: rigid, shape: {box: 40 20 5 mm}, mass: 20 g, pose: {position: 60 5 0 mm}}
  cart: {type: rigid, shape: {sphere: {radius: 5 mm}}, mass: 20 g, pose: {position: 0 100 0 mm}}
  tail: {type: rigid, shape: {sphere: {radius: 5 mm}}, mass: 20 g, pose: {position: 0 120 0 mm}}
joints:
  shaft: {type: hinge, bodies: [world, crank], point: 0 0 0 mm, axis: y}
  knee: {type: universal, bodies: [crank, bob], point: 50 0 0 mm, axes: [0 1 0, 0 0 1]}
  guide: {type: slider, bodies: [world, cart], point: 0 100 0 mm, axis: z}
  seam: {type: weld, bodies: [cart, tail]}
)";

// The initial poses of the bodies have the axes of the world.
Vector3 carried(const sim::Simulation& simulation, const char* body, const Vector3& from_origin) {
  const auto* pose =
      mechanics::as<const mechanics::HasPose>(simulation.body(simulation.model().body_index(body)));
  return pose->origin() + pose->axes() * from_origin;
}

TEST(JointMarks, AreWhereTheBodiesTakeThem) {
  const scene::Robot robot = scene::build(scene::parse_scene_text(kJoints, "test", {}));
  sim::Simulation simulation(robot.model, robot.threads());
  for (int k = 0; k < 60; ++k) simulation.step();
  const std::vector<float> marks = joint_marks(simulation);
  ASSERT_EQ(marks.size(), 12U * 4U);
  const auto near = [&](int joint, int part, const Vector3& expected) {
    const auto* from = marks.data() + 12 * joint + 3 * part;
    const Vector3 found = Eigen::Map<const Eigen::Vector3f>(from).cast<double>();
    EXPECT_LT((found - expected).norm(), 1e-6) << "joint " << joint << ", part " << part;
  };
  const Vector3 none = Vector3::Zero(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  near(0, 0, none);
  near(0, 1, carried(simulation, "crank", {-0.025, 0.0, 0.0}));
  near(0, 2, y);
  near(0, 3, none);
  near(1, 0, carried(simulation, "crank", {0.025, 0.0, 0.0}));
  near(1, 1, carried(simulation, "bob", {-0.01, -0.005, 0.0}));
  near(1, 2, carried(simulation, "crank", y) - carried(simulation, "crank", none));
  near(1, 3, carried(simulation, "bob", z) - carried(simulation, "bob", none));
  const Vector3 cart = carried(simulation, "cart", none);
  EXPECT_LT(cart.z(), -0.015);
  near(2, 0, {0.0, 0.1, 0.0});
  near(2, 1, cart);
  near(2, 2, z);
  near(3, 1, sim::joint_load(simulation, 3).centre);
  near(3, 2, none);
}

}  // namespace
}  // namespace sinew::viewer
