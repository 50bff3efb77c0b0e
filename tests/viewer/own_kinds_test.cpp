// The description of a robot with kinds of parts that the library does not know.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"

#include "../toys/scene_kinds.hpp"
#include "viewer/describe.hpp"

namespace sinew::viewer {
namespace {

// Before any test reads a scene.
const bool kRegistered = (testing::register_toys(), true);

TEST(OwnKinds, AreDescribed) {
  ASSERT_TRUE(kRegistered);
  const scene::Robot robot = scene::build(scene::parse_scene_text(
      "sinew: 1\ntime_step: 10 ms\n"
      "bodies: {point: {type: spring-point, at: 0 0 100 mm, mass: 100 g, stiffness: 50 N/m}}\n"
      "actuators: {rod: {type: strut, body: point, point: 0 0 100 mm, anchor: 100 0 100 mm}}\n",
      "scene.yaml", {}));
  sim::Simulation simulation(robot.model);
  const Description description = describe(robot, sim::Observables(simulation));
  const auto json = nlohmann::json::parse(description.scene);
  EXPECT_EQ(json["bodies"][0]["name"], "point");
  EXPECT_EQ(json["bodies"][0]["elements"], 0);
  const auto& rod = json["actuators"][0];
  EXPECT_EQ(rod["type"], "strut");
  EXPECT_EQ(rod["quantities"][0]["name"], "pull") << "what the scene commands comes first";
  EXPECT_EQ(rod["quantities"][1]["name"], "shortening");
  EXPECT_EQ(rod["quantities"][1]["unit"], "m");
  EXPECT_LT(rod["quantities"][1]["low"], 0.0);
  ASSERT_EQ(description.surfaces.size(), 1u);
  EXPECT_EQ(description.surfaces[0].node_count, 0) << "nothing to draw or to pick";
}

}  // namespace
}  // namespace sinew::viewer
