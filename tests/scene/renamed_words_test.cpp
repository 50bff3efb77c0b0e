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

TEST(RenamedWords, AUserIsToldTheNewWord) {
  parse(kNow);
  expect_refused(robot("pressure", "corotated", "centre"), ErrorKind::unknown_choice,
                 "'pressure' has another name now; write chamber", 10);
  expect_refused(robot("chamber", "rotated", "centre"), ErrorKind::unknown_choice,
                 "'rotated' has another name now; write corotated", 2);
  expect_refused(robot("chamber", "corotated", "center"), ErrorKind::unknown_key,
                 "'center' in sphere has another name now; write centre", 8);
}

TEST(RenamedWords, AnOldTreeBecomesTheNewOne) {
  Node tree = parse_yaml(kOld, "old");
  const Node now = parse_yaml(kNow, "now");
  ASSERT_FALSE(tree == now);
  replace_renamed_words(tree);
  EXPECT_TRUE(tree == now) << to_yaml(tree);
  replace_renamed_words(tree);
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

TEST(RenamedWords, AWordThatIsInUseIsNotOld) {
  EXPECT_EQ(current_word("center", {"centre", "radius"}), "centre");
  EXPECT_FALSE(current_word("center", {"centre", "center"}));
  EXPECT_FALSE(current_word("center", {"radius"}));
  EXPECT_FALSE(current_word("radius", {"centre"}));
}

TEST(RenamedWords, WhatIsNoSceneStays) {
  Node list = parse_yaml("[center, rotated]", "list");
  const Node before = list;
  replace_renamed_words(list);
  EXPECT_TRUE(list == before);
}

}  // namespace
}  // namespace sinew::scene
