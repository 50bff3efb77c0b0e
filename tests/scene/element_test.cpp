// The default element of a body, and the notice about linear tetrahedra that lock.
#include <algorithm>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "sinew/fem/element_count.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/write.hpp"
#include "sinew/model/model.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/statics/static_settings.hpp"

#include "scene_fixture.hpp"

namespace sinew::scene {
namespace {

constexpr const char* kShape = "{shape: block, length: 60 mm, width: 20 mm, height: 20 mm}";
constexpr const char* kRubber = "{model: neo-hookean, young_modulus: 60 kPa, poisson_ratio: 0.49}";

Robot robot(const std::string& mesh, const std::string& material, const std::string& more = "") {
  return build(parse_scene_text("sinew: 1\nbodies:\n  beam:\n    type: fem\n    mesh: " + mesh +
                                    "\n    material: " + material +
                                    "\n    fixed: [{box: -1 -1 -1 1 100 100 mm}]\n" +
                                    (more.empty() ? "" : "    " + more + "\n"),
                                "scene.yaml", {}));
}

/// A beam under its weight.
Robot heavy(const std::string& mesh, const std::string& material, const std::string& element) {
  return build(parse_scene_text(
      "sinew: 1\ngravity: 0 0 -0.01 m/s^2\nbodies:\n  beam:\n    type: fem\n    mesh: " + mesh +
          "\n    material: " + material + "\n    element: " + element +
          "\n    density: 1000 kg/m^3\n    fixed: {set: x_min}\n",
      "scene.yaml", {}));
}

const fem::FemModel& elements(const Robot& robot) {
  return mechanics::as<const fem::HasElements>(robot.model->body(0))->elements();
}

std::string element(const Robot& robot) {
  const auto kinds = fem::count_elements(elements(robot));
  EXPECT_EQ(kinds.size(), 1U);
  return std::string(kinds.front().element);
}

bool has(const Robot& robot, NoticeKind kind) {
  return std::ranges::find(robot.notices, kind, &Notice::kind) != robot.notices.end();
}

std::string written(const SceneFolder& folder, const mesh::Mesh& mesh) {
  const auto path = folder.path() / "beam.vtu";
  mesh::write_vtu(path, mesh);
  return "{file: " + path.string() + "}";
}

TEST(DefaultElement, RubbersGetQuadraticTetrahedra) {
  for (const char* material : {"dragon-skin-30", "ecoflex-00-30", kRubber}) {
    const Robot made = robot(kShape, material);
    EXPECT_EQ(element(made), "tet10") << material;
    EXPECT_FALSE(has(made, NoticeKind::locking_element)) << material;
  }
  EXPECT_EQ(fem::describe_elements(elements(robot(kShape, kRubber))), "144 tet10 elements");
}

TEST(DefaultElement, SoDoesEveryHyperelasticLawAtAnyPoissonRatio) {
  for (const char* material :
       {"{model: neo-hookean, young_modulus: 60 kPa, poisson_ratio: 0.4}",
        "{model: neo-hookean, young_modulus: 60 kPa, poisson_ratio: 0}",
        "{model: saint-venant-kirchhoff, young_modulus: 60 kPa, poisson_ratio: 0.3}",
        "{model: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 14 kPa}"}) {
    const Robot made = robot(kShape, material);
    EXPECT_EQ(element(made), "tet10") << material;
    EXPECT_FALSE(has(made, NoticeKind::locking_element)) << material;
  }
}

TEST(DefaultElement, LinearAndCorotationalLawsKeepLinearTetrahedra) {
  for (const char* model : {"linear", "corotational"}) {
    const Robot made = robot(
        kShape, std::string("{model: ") + model + ", young_modulus: 60 kPa, poisson_ratio: 0.3}");
    EXPECT_EQ(element(made), "tet4") << model;
    ASSERT_EQ(made.notices.size(), 1U) << model;
    EXPECT_EQ(made.notices.front().kind, NoticeKind::locking_element) << model;
  }
}

TEST(DefaultElement, WhatTheSceneSaysHolds) {
  for (const char* word : {"tet4", "tet4-patch", "tet10", "hex8"}) {
    EXPECT_EQ(element(robot(kShape, kRubber, std::string("element: ") + word)), word);
  }
}

TEST(DefaultElement, MiddleNodesFollowThoseOfTheFile) {
  const SceneFolder folder;
  const mesh::Mesh linear = mesh::block({.cells = {3, 2, 2}});
  const Robot made = robot(written(folder, linear), kRubber);
  const mesh::Mesh& quadratic = elements(made).mesh();
  ASSERT_EQ(element(made), "tet10");
  ASSERT_GT(quadratic.node_count(), linear.node_count());
  EXPECT_EQ(Points(quadratic.nodes.topRows(linear.node_count())), linear.nodes);
  EXPECT_EQ(quadratic.tetrahedra, linear.tetrahedra);
}

TEST(DefaultElement, HexahedraAndQuadraticFilesStay) {
  const SceneFolder folder;
  const mesh::Mesh hexahedra = mesh::block({.cells = {3, 2, 2}}, mesh::Cells::hexahedra);
  EXPECT_EQ(element(robot(written(folder, hexahedra), kRubber)), "hex8");
  const mesh::Mesh quadratic = mesh::with_middle_nodes(mesh::block({.cells = {3, 2, 2}}));
  const Robot made = robot(written(folder, quadratic), kRubber);
  EXPECT_EQ(element(made), "tet10");
  EXPECT_EQ(elements(made).mesh().node_count(), quadratic.node_count());
}

/// The factor that the notice about locking states; 1 without a notice.
double stated(const Robot& robot) {
  for (const Notice& notice : robot.notices) {
    if (notice.kind != NoticeKind::locking_element) continue;
    std::smatch number;
    EXPECT_TRUE(std::regex_search(notice.message, number, std::regex("([0-9.]+) times")))
        << notice.message;
    return std::stod(number[1]);
  }
  return 1.0;
}

TEST(LockingNotice, ADefaultWarnsAndAChoiceIsRemarkedOn) {
  const std::string material = "{model: corotational, young_modulus: 60 kPa, poisson_ratio: 0.45}";
  const Robot tacit = robot(kShape, material);
  ASSERT_EQ(tacit.notices.size(), 1U);
  const Notice& warning = tacit.notices.front();
  EXPECT_EQ(warning.level, NoticeLevel::warning);
  EXPECT_EQ(notice_kind_name(warning.kind), "locking-element");
  EXPECT_EQ(warning.place.item, "bodies.beam.material");
  for (const char* word : {"tet4", "0.45", "3.8 times", "element: tet10", "neo-hookean"}) {
    EXPECT_NE(warning.text().find(word), std::string::npos) << word << " in " << warning.text();
  }
  const Robot chosen = robot(kShape, material, "element: tet4");
  ASSERT_EQ(chosen.notices.size(), 1U);
  EXPECT_EQ(chosen.notices.front().level, NoticeLevel::remark);
  EXPECT_EQ(chosen.notices.front().place.item, "bodies.beam.element");
  EXPECT_EQ(robot(kShape, kRubber, "element: tet4").notices.size(), 1U);
}

// One element through the thickness: patches lock in shear, and hexahedra too.
// Mean dilatations make single hexahedra in bending too soft.
TEST(LockingNotice, SoftElementsAreToldToo) {
  const Robot soft =
      heavy("{shape: block, length: 80 mm, width: 10 mm, height: 10 mm, element_size: 10 mm}",
            "{model: neo-hookean, young_modulus: 60 kPa, poisson_ratio: 0.45}", "hex8");
  ASSERT_EQ(soft.notices.size(), 1U);
  EXPECT_NE(soft.notices.front().text().find("times too soft under 'gravity'"), std::string::npos)
      << soft.notices.front().text();
}

// Few elements through the thickness: patches lock in shear, and long hexahedra too.
TEST(LockingNotice, PatchesAndHexahedraAreJudged) {
  const std::string shape =
      "{shape: block, length: 80 mm, width: 10 mm, height: 10 mm, element_size: ";
  for (const char* element : {"tet4-patch", "hex8"}) {
    const Robot coarse = heavy(shape + "20 mm}", kRubber, element);
    ASSERT_EQ(coarse.notices.size(), 1U) << element;
    EXPECT_EQ(coarse.notices.front().level, NoticeLevel::warning) << element;
    EXPECT_NE(coarse.notices.front().text().find(element), std::string::npos);
    EXPECT_GT(stated(coarse), 1.2) << element;
  }
  EXPECT_TRUE(heavy(shape + "2.5 mm}", kRubber, "hex8").notices.empty());
}

/// Mean motion of the first body's nodes up to `nodes` in equilibrium.
double mean_motion(const Robot& robot, Eigen::Index nodes) {
  sim::Simulation simulation(robot.model);
  simulation.solve_static();
  const Points& now = simulation.body(0).positions();
  const Points& rest = robot.model->body(0).mesh().nodes;
  return (now - rest).topRows(nodes).rowwise().norm().mean();
}

/// Bodies, and what acts on them so weakly that they respond linearly.
struct Case {
  const char* body;  ///< mesh, material and supports
  const char* element;
  const char* acts;
};

class LockingFactor : public ::testing::TestWithParam<Case> {};

// The statement is about the scene's own actuators and loads: shear, bulging walls, thin ribs.
TEST_P(LockingFactor, IsThatOfTheScenesOwnEquilibrium) {
  const auto made = [&](const std::string& element, const std::string& gravity) {
    return build(parse_scene_text(
        "sinew: 1\ngravity: " + gravity + "\nsolver: {tolerance: 1e-9}\n" +
            "bodies:\n  beam:\n    type: fem\n    density: 1000 kg/m^3\n    element: " + element +
            "\n" + GetParam().body + GetParam().acts,
        "scene.yaml", {}));
  };
  const bool by_gravity = std::string(GetParam().acts).empty();
  const std::string gravity = by_gravity ? "0 0 -0.01 m/s^2" : "0 0 0 m/s^2";
  const Robot linear = made(GetParam().element, gravity), quadratic = made("tet10", gravity);
  const Eigen::Index nodes = linear.model->body(0).mesh().nodes.rows();
  const double expected = mean_motion(quadratic, nodes) / mean_motion(linear, nodes);
  EXPECT_NEAR(stated(linear), expected, 0.1 * expected);
  EXPECT_GT(expected, 1.1);
}

constexpr const char* kBar =
    "    mesh: {shape: block, length: 60 mm, width: 10 mm, height: 10 mm}\n"
    "    material: {model: neo-hookean, young_modulus: 60 kPa, poisson_ratio: 0.3}\n"
    "    fixed: {set: x_min}\n";
constexpr const char* kRibs =
    "    mesh: {shape: ribbed-finger, length: 60 mm, width: 12 mm, height: 12 mm, ribs: 4}\n"
    "    material: {model: neo-hookean, young_modulus: 60 kPa, poisson_ratio: 0.45}\n"
    "    fixed: {set: x_min}\n";
constexpr const char* kModule =
    "    mesh: {shape: chambered-cylinder, radius: 8 mm, height: 30 mm, chamber_radius: 5 mm,\n"
    "           chamber_bottom: 3 mm, chamber_top: 27 mm}\n"
    "    material: {model: neo-hookean, young_modulus: 60 kPa, poisson_ratio: 0.49}\n"
    "    fixed: {set: bottom}\n";
constexpr const char* kAir =
    "actuators:\n  air: {type: chamber, body: beam, surface: {set: chamber}, command: {pressure: "
    "0.01 "
    "Pa}}\n";
constexpr const char* kCable =
    "actuators:\n  pull: {type: cable, body: beam, points: [0 6 10 mm, 60 6 10 mm], guide_radius: "
    "2 mm,"
    "\n         command: {tension: 1e-4 N}}\n";
constexpr const char* kPush =
    "loads:\n  push: {type: force, body: beam, point: 60 5 5 mm, force: 0 1e-5 0 N}\n";

INSTANTIATE_TEST_SUITE_P(Robots, LockingFactor,
                         ::testing::Values(Case{kBar, "tet4", ""}, Case{kBar, "tet4-patch", kPush},
                                           Case{kRibs, "tet4", kCable},
                                           Case{kRibs, "tet4-patch", kCable},
                                           Case{kModule, "tet4", kAir}));

// A body that joints or contacts hold is free as far as its own elements are concerned.
TEST(LockingNotice, AFreeBodyIsJudgedByWhatDeformsIt) {
  const Robot free = build(parse_scene_text(
      "sinew: 1\nintegrator: backward-euler\nbodies:\n  beam:\n    type: fem\n    density: 1000 "
      "kg/m^3\n    element: tet4\n    mesh: {shape: block, length: 60 mm, width: 10 mm, height: 10 "
      "mm}\n    material: {model: neo-hookean, young_modulus: 60 kPa, poisson_ratio: 0.45}\n" +
          std::string(
              "actuators:\n  pull: {type: cable, body: beam, points: [0 5 9 mm, 60 5 9 mm]}\n"),
      "scene.yaml", {}));
  const Robot held = build(parse_scene_text(
      "sinew: 1\nbodies:\n  beam:\n    type: fem\n    density: 1000 "
      "kg/m^3\n    element: tet4\n    mesh: {shape: block, length: 60 mm, width: 10 mm, height: 10 "
      "mm}\n    material: {model: neo-hookean, young_modulus: 60 kPa, poisson_ratio: 0.45}\n    "
      "fixed: "
      "{set: x_min}\n" +
          std::string(
              "actuators:\n  pull: {type: cable, body: beam, points: [0 5 9 mm, 60 5 9 mm]}\n"),
      "scene.yaml", {}));
  EXPECT_GT(stated(free), 1.5);
  EXPECT_NEAR(stated(free), stated(held), 0.3 * stated(held));
}

}  // namespace
}  // namespace sinew::scene
