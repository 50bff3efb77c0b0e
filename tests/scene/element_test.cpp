// The default element of a body, and the notice about linear tetrahedra that lock.
#include <gtest/gtest.h>

#include "sinew/fem/element_count.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/write.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/sim/model.hpp"

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

const fem::FemModel& elements(const Robot& robot) {
  return mechanics::as<const fem::HasElements>(robot.model->body(0))->elements();
}

std::string element(const Robot& robot) {
  const auto kinds = fem::count_elements(elements(robot));
  EXPECT_EQ(kinds.size(), 1U);
  return std::string(kinds.front().element);
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
    EXPECT_TRUE(made.notices.empty()) << material;
  }
  EXPECT_EQ(fem::describe_elements(elements(robot(kShape, kRubber))), "144 tet10 elements");
}

TEST(DefaultElement, UpToFourTenthsTetrahedraStayLinear) {
  for (const char* material :
       {"{model: neo-hookean, young_modulus: 60 kPa, poisson_ratio: 0.4}",
        "{model: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 14 kPa}",  // nu = 0.4
        "{model: corotational, young_modulus: 60 kPa, poisson_ratio: 0.4}"}) {
    const Robot made = robot(kShape, material);
    EXPECT_EQ(element(made), "tet4") << material;
    EXPECT_TRUE(made.notices.empty()) << material;
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

TEST(LockingNotice, ADefaultWarnsAndAChoiceIsRemarkedOn) {
  const std::string material = "{model: corotational, young_modulus: 60 kPa, poisson_ratio: 0.45}";
  const Robot tacit = robot(kShape, material);
  ASSERT_EQ(tacit.notices.size(), 1U);
  const Notice& warning = tacit.notices.front();
  EXPECT_EQ(warning.level, NoticeLevel::warning);
  EXPECT_EQ(notice_kind_name(warning.kind), "locking-element");
  EXPECT_EQ(warning.place.item, "bodies.beam.material");
  for (const char* word : {"tet4", "0.45", "3.5 times", "element: tet10", "neo-hookean"}) {
    EXPECT_NE(warning.text().find(word), std::string::npos) << word << " in " << warning.text();
  }
  const Robot chosen = robot(kShape, material, "element: tet4");
  ASSERT_EQ(chosen.notices.size(), 1U);
  EXPECT_EQ(chosen.notices.front().level, NoticeLevel::remark);
  EXPECT_EQ(chosen.notices.front().place.item, "bodies.beam.element");
  EXPECT_EQ(robot(kShape, kRubber, "element: tet4").notices.size(), 1U);
  EXPECT_TRUE(robot(kShape, kRubber, "element: tet4-patch").notices.empty());
}

}  // namespace
}  // namespace sinew::scene
