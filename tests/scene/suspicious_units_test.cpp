// Notices about numbers whose unit was probably forgotten.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/core/notice.hpp"
#include "sinew/scene/build.hpp"

#include "scene/scene_fixture.hpp"

namespace sinew::scene {
namespace {

using ::testing::HasSubstr;

const std::string kChambers = R"(sinew: 1
bodies:
  finger:
    type: fem
    mesh: {shape: hollow-cylinder, inner_radius: 5 mm, outer_radius: 8 mm, height: 60 mm}
    material: {young_modulus: MODULUS, poisson_ratio: 0.4}
    density: DENSITY
    fixed: {set: bottom}
actuators:
  air:
    type: chamber
    body: finger
    surface: {set: inner}
    cap: true
    command: {pressure: COMMAND}
masses:
  tip: {body: finger, point: 6.5 0 60 mm, mass: MASS}
)";

SceneDescription scene(const std::string& modulus, const std::string& density,
                       const std::string& command, const std::string& mass,
                       const std::filesystem::path& folder = {}) {
  std::string text = kChambers;
  const auto put = [&](const std::string& word, const std::string& value) {
    text.replace(text.find(word), word.size(), value);
  };
  put("MODULUS", modulus);
  put("DENSITY", density);
  put("COMMAND", command);
  put("MASS", mass);
  return parse_scene_text(text, "scene.yaml", folder,
                          folder.empty() ? Files::ignore : Files::check);
}

TEST(SuspiciousUnits, NumbersWithUnitsOrOfUsualSizeAreFine) {
  for (const char* pressure :
       {"30 kPa", "30e3", "0", "30 Pa", "-20 kPa", "{ramp: {from: 10, to: 30e3, duration: 1 s}}",
        "{steps: [[0 s, 0], [1 s, 5], [2 s, 2e4]]}",
        "{sine: {mean: 5 kPa, amplitude: 5, period: 1 s}}"}) {
    EXPECT_TRUE(scene("450e3", "1070", pressure, "0.005").notices.empty()) << pressure;
  }
  EXPECT_TRUE(scene("450 Pa", "1 kg/m^3", "30 Pa", "42 kg").notices.empty());
}

TEST(SuspiciousUnits, BareNumbersFarFromRobotsAreNamed) {
  const auto only = [](const SceneDescription& found) {
    EXPECT_EQ(found.notices.size(), 1U);
    return found.notices.empty() ? Notice{} : found.notices.front();
  };
  const Notice modulus = only(scene("450", "1070", "0", "5 g"));
  EXPECT_EQ(modulus.kind, NoticeKind::suspicious_unit);
  EXPECT_EQ(modulus.level, NoticeLevel::warning);
  EXPECT_EQ(modulus.place.item, "bodies.finger.material.young_modulus");
  EXPECT_EQ(modulus.place.line, 6);
  EXPECT_THAT(modulus.text(), HasSubstr("450 without a unit is 450 Pa"));
  EXPECT_THAT(modulus.text(), HasSubstr("450 kPa"));
  EXPECT_EQ(only(scene("450 kPa", "1.07", "0", "5 g")).place.item, "bodies.finger.density");
  EXPECT_EQ(only(scene("450 kPa", "1070", "0", "42")).place.item, "masses.tip.mass");
  for (const char* pressure :
       {"30", "-20", "{ramp: {to: 30, duration: 1 s}}", "{steps: [[0 s, 0], [1 s, 30]]}",
        "{sine: {amplitude: 30, period: 1 s}}"}) {
    const Notice found = only(scene("450 kPa", "1070", pressure, "5 g"));
    EXPECT_THAT(found.place.item, HasSubstr("actuators.air.command.pressure")) << pressure;
  }
}

TEST(SuspiciousUnits, FilesOfSignalsCount) {
  const SceneFolder folder;
  const auto notices = [&](const char* table, const char* more = "") {
    folder.write("air.csv", table);
    return scene("450 kPa", "1070", std::string("{file: air.csv") + more + "}", "5 g",
                 folder.path())
        .notices.size();
  };
  EXPECT_EQ(notices("0,0\n1,30\n"), 1U);
  EXPECT_EQ(notices("time,pressure\n0,0\n1,30\n", ", column: pressure"), 1U);
  EXPECT_EQ(notices("time [s],pressure [Pa]\n0,0\n1,30\n"), 0U);
  EXPECT_EQ(notices("time,pressure [kPa]\n0,0\n1,30\n", ", column: pressure"), 0U);
  EXPECT_EQ(notices("0,0\n1,30\n", ", unit: kPa"), 0U);
  EXPECT_EQ(notices("0,0\n1,30e3\n"), 0U);
}

// Quantities that share a dimension differ in their usual size.
TEST(SuspiciousUnits, ANumberIsJudgedByWhatItIs) {
  const auto text = [](const std::string& load) {
    std::string all = kChambers;
    for (const auto& [word, value] :
         Edits{{"MODULUS", "1 MPa"}, {"DENSITY", "1070"}, {"COMMAND", "0"}, {"MASS", "1 g"}}) {
      all.replace(all.find(word), word.size(), value);
    }
    std::string told;
    const SceneDescription found = parse_scene_text(all + load, "scene.yaml", {}, Files::ignore);
    for (const Notice& notice : found.notices) told += notice.text() + "\n";
    return told;
  };
  const auto line = [&](const std::string& force) {
    return text(
        "loads: {l: {type: line, body: finger, points: [6 0 0 mm, 6 0 50 mm], "
        "force_per_length: [0, 0, " +
        force + "]}}\n");
  };
  EXPECT_EQ(line("-0.5"), "");
  EXPECT_EQ(line("0.01"), "");
  EXPECT_THAT(line("1e-5"), HasSubstr("is little for a force per length"));
  EXPECT_THAT(line("1e-5"), HasSubstr("N/mm"));
  const auto traction = [&](const std::string& stress) {
    return text("loads: {l: {type: traction, body: finger, surface: {set: top}, traction: [" +
                stress + ", 0, 0]}}\n");
  };
  EXPECT_EQ(traction("100"), "");
  EXPECT_THAT(traction("0.1"), HasSubstr("is little for a force per area"));
  EXPECT_THAT(
      text("loads: {l: {type: pressure, body: finger, surface: {set: top}, pressure: 30}}\n"),
      HasSubstr("is little for a pressure;"));
  EXPECT_THAT(text("membranes: {m: {body: finger, surface: {set: top}, thickness: 0.1 mm, "
                   "young_modulus: 30}}\n"),
              HasSubstr("is little for a modulus;"));
}

TEST(SuspiciousUnits, OverridesCount) {
  SceneDescription plain = scene("450 kPa", "1070", "0", "5 g");
  Node tree = plain.tree;
  apply_override(tree, "actuators.air.command.pressure=30");
  const SceneDescription changed = parse_scene_tree(std::move(tree), {}, Files::ignore);
  ASSERT_EQ(changed.notices.size(), 1U);
  EXPECT_THAT(changed.notices.front().text(), HasSubstr("--set"));
}

// The words of other programs, and of the field, have suggestions.
TEST(OtherWords, AreSuggested) {
  const auto remedy = [](const std::string& from, const std::string& to) {
    std::string text = kChambers;
    for (const auto& [word, value] : Edits{{"MODULUS", "1 MPa"},
                                           {"DENSITY", "1070"},
                                           {"COMMAND", "0"},
                                           {"MASS", "1 g"},
                                           {from, to}}) {
      text.replace(text.find(word), word.size(), value);
    }
    try {
      parse_scene_text(text, "scene.yaml", {}, Files::ignore);
    } catch (const Error& error) {
      return error.remedy();
    }
    return std::string("no error");
  };
  EXPECT_THAT(remedy("type: chamber", "type: tendon"), HasSubstr("did you mean 'cable'?"));
  EXPECT_THAT(remedy("type: chamber", "type: pneumatic"), HasSubstr("did you mean 'chamber'?"));
  EXPECT_THAT(remedy("shape: hollow-cylinder", "shape: box"), HasSubstr("did you mean 'block'?"));
  EXPECT_THAT(remedy("density: 1070", "density: 1070\n    element: C3D10"),
              HasSubstr("did you mean 'tet10'?"));
  EXPECT_THAT(remedy("poisson_ratio: 0.4", "nu: 0.4"), HasSubstr("did you mean 'poisson_ratio'?"));
  EXPECT_THAT(remedy("sinew: 1", "sinew: 1\ndt: 1 ms"), HasSubstr("did you mean 'time_step'?"));
  EXPECT_THAT(remedy("sinew: 1", "sinew: 1\nintegrator: newmark"),
              HasSubstr("did you mean 'generalized-alpha'?"));
}

TEST(Override, OfALibraryMaterialNamesItsScale) {
  const SceneDescription library = parse_edited(
      {{"{model: corotational, young_modulus: 450 kPa, poisson_ratio: 0.45}", "dragon-skin-30"},
       {"element: tet4 ", "element: tet10 "}});
  Node tree = library.tree;
  try {
    apply_override(tree, "bodies.trunk.material.young_modulus=100 kPa");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::conflicting_keys);
    EXPECT_THAT(error.what(), HasSubstr("dragon-skin-30"));
    EXPECT_THAT(error.what(), HasSubstr("bodies.trunk.material.scale"));
  }
  apply_override(tree, "bodies.trunk.material.scale=1.2");
  EXPECT_NO_THROW(parse_scene_tree(tree, {}, Files::ignore));
  apply_override(tree, "bodies.trunk.material={young_modulus: 100 kPa, poisson_ratio: 0.4}");
  apply_override(tree, "bodies.trunk.material.young_modulus=200 kPa");
  EXPECT_NO_THROW(parse_scene_tree(tree, {}, Files::ignore));
}

}  // namespace
}  // namespace sinew::scene
