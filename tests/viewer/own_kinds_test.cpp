// The view of a robot with kinds of parts that the library does not know.
#include <cmath>
#include <memory>
#include <optional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"

#include "../toys/scene_kinds.hpp"
#include "viewer/describe.hpp"
#include "viewer/robot_state.hpp"

namespace sinew::viewer {
namespace {

// Before any test reads a scene.
const bool kRegistered = (testing::register_toys(), true);

const scene::Robot& robot() {
  static const scene::Robot made = scene::build(scene::parse_scene_text(
      "sinew: 1\ntime_step: 10 ms\n"
      "bodies: {point: {type: spring-point, at: 0 0 100 mm, mass: 100 g, stiffness: 50 N/m}}\n"
      "actuators: {rod: {type: strut, body: point, point: 0 0 100 mm, anchor: 100 0 100 mm}}\n"
      "effectors: {place: {body: point, point: 0 0 100 mm}}\n"
      "controllers: {follow: {type: proportional, effectors: {place: {target: 5 0 80 mm}}}}\n",
      "scene.yaml", {}));
  return made;
}

TEST(OwnKinds, AreDescribed) {
  ASSERT_TRUE(kRegistered);
  sim::Simulation simulation(robot().model);
  const Description description = describe(robot(), sim::Observables(simulation));
  const auto json = nlohmann::json::parse(description.scene);
  EXPECT_EQ(json["bodies"][0]["name"], "point");
  EXPECT_EQ(json["bodies"][0]["elements"], 0);
  const auto& rod = json["actuators"][0];
  EXPECT_EQ(rod["type"], "strut");
  EXPECT_EQ(rod["quantities"][0]["name"], "pull") << "what the scene commands comes first";
  EXPECT_EQ(rod["quantities"][1]["name"], "shortening");
  EXPECT_EQ(rod["quantities"][1]["unit"], "m");
  EXPECT_LT(rod["quantities"][1]["low"], 0.0);
  EXPECT_EQ(json["controllers"][0]["type"], "proportional");
  EXPECT_EQ(json["controllers"][0]["effectors"][0], "place");
  ASSERT_EQ(description.surfaces.size(), 1u);
  EXPECT_EQ(description.surfaces[0].node_count, 0) << "nothing to draw or to pick";
}

TEST(OwnKinds, AControllerIsAttachedAndNamed) {
  RobotState state(robot(), std::make_shared<sim::Simulation>(robot().model),
                   robot().controllers[0]);
  state.step();
  const std::size_t change = state.observables().find("follow.change");
  state.observables().refresh();
  EXPECT_GT(state.observables().number(change), 0.0);
  const auto status = nlohmann::json::parse(state.status_members());
  EXPECT_EQ(status["controller"], "follow");
  state.reset();
  state.step();
  state.observables().refresh();
  EXPECT_GT(state.observables().number(change), 0.0) << "of the controller made by reset()";
  state.choose_controller(std::nullopt);
  state.observables().refresh();
  EXPECT_TRUE(std::isnan(state.observables().number(change)));
}

}  // namespace
}  // namespace sinew::viewer
