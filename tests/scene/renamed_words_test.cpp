#include "sinew/scene/renamed_words.hpp"

#include <gtest/gtest.h>

#include "sinew/scene/scene.hpp"

#include "scene_fixture.hpp"

namespace sinew::scene {
namespace {

// The same robot with old and current words. A body and an actuator have old words as names, and
// `pressure` is still a type of sensors and loads.
std::string robot(const std::string& chamber, const std::string& tangent,
                  const std::string& centre) {
  return R"(sinew: 1
solver: {tangent: )" +
         tangent + R"(}
bodies:
  center:
    type: fem
    mesh: {file: finger.vtk, unit: mm}
    material: {model: corotational, young_modulus: 450 kPa, poisson_ratio: 0.45}
    fixed: {sphere: {)" +
         centre + R"(: 0 0 0 mm, radius: 5 mm}}
actuators:
  pressure: {type: )" +
         chamber + R"(, body: center, surface: {set: inner}, command: {pressure: 1 kPa}}
loads:
  wind: {type: pressure, body: center, surface: {set: outer}, pressure: 10 Pa}
sensors:
  gauge: {type: pressure, actuator: pressure}
)";
}

const std::string kOld = robot("pressure", "rotated", "center"),
                  kNow = robot("chamber", "corotated", "centre");

void expect_refused(const std::string& text, ErrorKind kind, const std::string& message, int line) {
  try {
    parse(text);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    EXPECT_EQ(error.place().line, line) << error.what();
  }
}

TEST(RenamedWords, AreReadWithANotice) {
  EXPECT_TRUE(parse(kNow).notices.empty());
  const SceneDescription scene = parse(kOld);
  EXPECT_TRUE(scene.tree == parse(kNow).tree) << to_yaml(scene.tree);
  ASSERT_EQ(scene.notices.size(), 3U);
  EXPECT_EQ(scene.notices[0].text(),
            "scene.yaml:2:19: solver.tangent: 'rotated' has another name now; write corotated "
            "[renamed-word]");
  EXPECT_EQ(scene.notices[1].place.line, 8);
  EXPECT_EQ(scene.notices[2].place.line, 10);
}

// The factorisations that were there for reference.
TEST(RenamedWords, FactorisationsThatAreNoMore) {
  const std::string robot =
      "sinew: 1\nsolver: {factorisation: eigen-ldlt}\nbodies:\n"
      "  rod:\n"
      "    type: pcc\n"
      "    segments: [{length: 100 mm, mass: 10 g, stiffness: 0.1 N m}]\n";
  const SceneDescription scene = parse(robot);
  EXPECT_EQ(scene.solver.backend, "block");
  ASSERT_EQ(scene.notices.size(), 1U);
  EXPECT_EQ(scene.notices[0].kind, NoticeKind::renamed_word);
}

TEST(RenamedWords, AnOldTreeBecomesTheNewOne) {
  Node tree = parse_yaml(kOld, "old");
  const Node now = parse_yaml(kNow, "now");
  ASSERT_FALSE(tree == now);
  replace_old_words(tree);
  EXPECT_TRUE(tree == now) << to_yaml(tree);
  replace_old_words(tree);
  EXPECT_TRUE(tree == now) << to_yaml(tree);
}

TEST(RenamedWords, ARecordedSceneIsRead) {
  const std::string text =
      "sinew: 1\nsolver: {tangent: rotated}\nbodies:\n"
      "  rod:\n"
      "    type: pcc\n"
      "    segments: [{length: 100 mm, mass: 10 g, stiffness: 0.1 N m}]\n";
  EXPECT_EQ(parse_recorded_scene(text, "run").solver.tangent, mechanics::Tangent::corotated);
}

// A soft body and an arm, and the same with the keys of today.
const std::string kMoved = R"(sinew: 1
integrator: bdf2
bodies:
  soft:
    type: fem
    mesh: {shape: block, length: 10 mm, width: 10 mm, height: 10 mm, element_size: 10 mm}
    rotation: 0 0 90 deg
    material: {young_modulus: 450 kPa, poisson_ratio: 0.45}
    density: 1000
    fixed: {set: x_min}
    position: 0 0 60 mm
    initial_velocity: {linear: 0 0 1 m/s}
    base: {x: 1 mm}
  arm:
    type: pcc
    segments: [{length: 100 mm, mass: 10 g, stiffness: 0.1 N m}]
    position: 0 0 0.5 m
    direction: 0 0 1
    side: 0 1 0
)";
const std::string kPlaced = R"(sinew: 1
integrator: bdf2
bodies:
  soft:
    type: fem
    mesh: {shape: block, length: 10 mm, width: 10 mm, height: 10 mm, element_size: 10 mm}
    pose: {rotation: 0 0 90 deg, position: 0 0 60 mm}
    material: {young_modulus: 450 kPa, poisson_ratio: 0.45}
    density: 1000
    fixed: {set: x_min}
    velocity: {linear: 0 0 1 m/s}
    motion: {x: 1 mm}
  arm:
    type: pcc
    segments: [{length: 100 mm, mass: 10 g, stiffness: 0.1 N m}]
    pose: {position: 0 0 0.5 m, direction: 0 0 1, side: 0 1 0}
)";

TEST(MovedKeys, AreReadWithANotice) {
  const SceneDescription scene = parse(kMoved), now = parse(kPlaced);
  EXPECT_TRUE(scene.tree == now.tree) << to_yaml(scene.tree);
  EXPECT_TRUE(now.notices.empty());
  ASSERT_EQ(scene.notices.size(), 7U);
  EXPECT_EQ(scene.notices[0].text(),
            "scene.yaml:7:5: bodies.soft.rotation: 'rotation' has another name now; write pose: "
            "{rotation: ...} [renamed-word]");
  EXPECT_EQ(scene.notices[2].text(),
            "scene.yaml:12:5: bodies.soft.initial_velocity: 'initial_velocity' has another name "
            "now; write velocity [renamed-word]");
  EXPECT_EQ(scene.bodies[0].position, Vector3(0.0, 0.0, 0.06));
  EXPECT_DOUBLE_EQ(scene.bodies[0].rotation.z(), 1.5707963267948966);
  EXPECT_EQ(scene.bodies[0].velocity->linear, Vector3(0.0, 0.0, 1.0));
  EXPECT_EQ(scene.bodies[0].motion->translation[0].value(0.0), 1e-3);
  EXPECT_EQ(scene.bodies[1].as<pcc::ArmSettings>()->base, Vector3(0.0, 0.0, 0.5));
}

TEST(MovedKeys, ARecordedSceneHasThem) {
  EXPECT_TRUE(parse_recorded_scene(kMoved, "run").tree == parse(kPlaced).tree);
}

TEST(MovedKeys, ErrorsNameTheKeyOfToday) {
  std::string text = kMoved;
  text.replace(text.find("position: 0 0 60 mm"), 19, "position: 0 0 60 kg");
  expect_refused(text, ErrorKind::wrong_dimension, "bodies.soft.pose.position", 11);
}

TEST(MovedKeys, AKeyThatIsWrittenTwiceIsRefused) {
  expect_refused(kPlaced + "    position: 0 0 1 m\n", ErrorKind::unknown_key,
                 "'position' in body: type pcc has another name now; write pose: {position: ...}",
                 17);
}

TEST(MovedKeys, OverridesFindThem) {
  const auto change = [](const std::string& text, const std::string& assignment) {
    return parse_changed_scene(parse_yaml(text, "scene.yaml"), {assignment}, {});
  };
  for (const char* path : {"bodies.soft.position", "bodies.soft.pose.position"}) {
    for (const std::string& text : {kMoved, kPlaced}) {
      const SceneDescription scene = change(text, path + std::string("=0 0 70 mm"));
      EXPECT_EQ(scene.bodies[0].position, Vector3(0.0, 0.0, 0.07)) << path;
      EXPECT_DOUBLE_EQ(scene.bodies[0].rotation.z(), 1.5707963267948966) << "it stays";
    }
  }
  const SceneDescription old = change(kPlaced, "bodies.soft.position=0 0 70 mm");
  ASSERT_EQ(old.notices.size(), 1U);
  EXPECT_EQ(old.notices[0].text(),
            "--set: bodies.soft.position: 'position' has another name now; write pose: {position: "
            "...} [renamed-word]");
  EXPECT_EQ(change(kMoved, "bodies.arm.side=1 0 0").notices.size(), 8U);
  EXPECT_EQ(change(kPlaced, "bodies.soft.base.y=2 mm").bodies[0].motion->translation[1].value(0.0),
            2e-3);
}

TEST(Poses, OfAnArmTurnItFromHanging) {
  const auto frame = [](const std::string& pose) {
    std::string text = kPlaced;
    text.replace(text.find("direction: 0 0 1, side: 0 1 0"), 29, pose);
    return parse(text).bodies[1].as<pcc::ArmSettings>()->frame;
  };
  const Matrix3 hanging = Vector3(1.0, -1.0, -1.0).asDiagonal();
  EXPECT_EQ(frame("rotation: 0 0 0 rad"), hanging);
  const Matrix3 turned = frame("rotation: {axis: y, angle: -90 deg}");
  EXPECT_LT((turned - frame("direction: 1 0 0, side: 0 0 1")).norm(), 1e-15);
  expect_refused(kPlaced.substr(0, kPlaced.find("direction")) + "rotation: 0 0 1, side: 0 1 0}\n",
                 ErrorKind::conflicting_keys, "'rotation' and 'side' exclude each other", 16);
  expect_refused(
      kPlaced.substr(0, kPlaced.find("direction")) + "rotation: 0 0 1, direction: 0 1 0}\n",
      ErrorKind::conflicting_keys, "exclude each other", 16);
}

TEST(RenamedWords, AWordThatIsInUseIsNotOld) {
  EXPECT_EQ(current_word("center", {"centre", "radius"}), "centre");
  EXPECT_FALSE(current_word("center", {"centre", "center"}));
  EXPECT_FALSE(current_word("center", {"radius"}));
  EXPECT_FALSE(current_word("radius", {"centre"}));
}

TEST(RenamedWords, WhatIsNoSceneStays) {
  Node list = parse_yaml("[center, rotated]", "list");
  const Node before = list;
  replace_old_words(list);
  EXPECT_TRUE(list == before);
}

}  // namespace
}  // namespace sinew::scene
