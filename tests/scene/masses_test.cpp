// Point masses and initial velocities of bodies: reading, building, and invalid scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::scene {
namespace {

std::string scene(const std::string& more, const std::string& integrator = "bdf2",
                  const std::string& of_body = "") {
  return "sinew: 1\nintegrator: " + integrator + R"(
bodies:
  beam:
    type: fem
    mesh: {shape: block, length: 40 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}
    material: {young_modulus: 100 kPa, poisson_ratio: 0.4}
    density: 1000 kg/m^3
    fixed: {set: x_min}
)" + of_body +
         "  arm: {type: pcc, segments: [{length: 140 mm, mass: 146 g, stiffness: 0.108 N m}]}\n" +
         more;
}

SceneDescription parsed(const std::string& text) {
  return parse_scene_text(text, "scene.yaml", {});
}

void expect_error(const std::string& text, ErrorKind kind, const std::string& words, int line) {
  try {
    build(parsed(text));
    ADD_FAILURE() << "taken: " << text;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_EQ(error.place().line, line) << error.what();
    EXPECT_THAT(error.what(), testing::HasSubstr(words));
    EXPECT_FALSE(error.remedy().empty());
  }
}

TEST(Masses, AreReadAndHung) {
  const Robot robot = build(
      parsed(scene("masses:\n"
                   "  hung: {body: beam, point: 38 10 12 mm, mass: 52 g}\n"
                   "  far: {body: beam, point: 50 10 10 mm, mass: 0.001, outside: nearest}\n")));
  ASSERT_EQ(robot.description.masses.size(), 2u);
  EXPECT_DOUBLE_EQ(robot.description.masses[0].mass, 0.052);
  const auto& masses = robot.model->masses();
  ASSERT_EQ(masses.size(), 2u);
  EXPECT_EQ(masses[0].name, "hung");
  EXPECT_DOUBLE_EQ(masses[0].mass, 0.052);
  const mechanics::BodyModel& body = robot.model->body(0);
  EXPECT_LT((body.rest_position(masses[0].point) - Vector3(0.038, 0.010, 0.012)).norm(), 1e-15);
  EXPECT_LT((body.rest_position(masses[1].point) - Vector3(0.050, 0.010, 0.010)).norm(), 1e-15);
  const fem::FemModel& elements = mechanics::as<const fem::HasElements>(body)->elements();
  EXPECT_NEAR(elements.load_mass().sum(), 1000.0 * 1.6e-5 + 0.053, 1e-15);
}

TEST(Masses, WrongOnesAreErrors) {
  const auto with = [](const std::string& mass) { return scene("masses:\n  m: " + mass + "\n"); };
  expect_error(with("{body: arm, point: 0 0 0 mm, mass: 1 g}"), ErrorKind::wrong_type,
               "constant curvature", 12);
  expect_error(with("{body: beam, point: 0 0 0 mm, mass: 0 g}"), ErrorKind::out_of_range, "mass",
               12);
  expect_error(with("{body: beam, point: 0 0 0 mm}"), ErrorKind::missing_key, "mass", 12);
  expect_error(with("{body: beam, point: 0 0 0 mm, mass: 1 N}"), ErrorKind::wrong_dimension, "mass",
               12);
  expect_error(with("{body: beam, point: 1 0 0 m, mass: 1 g}"), ErrorKind::point_outside_mesh,
               "mass 'm'", 12);
  expect_error(with("{body: bean, point: 0 0 0 m, mass: 1 g}"), ErrorKind::unknown_name, "beam",
               12);
}

TEST(InitialVelocity, IsThatOfARigidBody) {
  const std::string text =
      scene("", "bdf2", "    velocity: {linear: 1 2 3 mm/s, angular: 0 0 2 rad/s}\n");
  sim::Simulation simulation(build(parsed(text)).model);
  const mechanics::Body& body = simulation.body(0);
  const Points& rest = body.model().mesh().nodes;
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const Vector3 arm = rest.row(i).transpose() - Vector3(0.02, 0.01, 0.01);
    Vector3 expected = Vector3(1e-3, 2e-3, 3e-3) + Vector3(0.0, 0.0, 2.0).cross(arm);
    if (rest(i, 0) == 0.0) expected.setZero();  // the node is fixed
    EXPECT_LT((body.velocities().row(i).transpose() - expected).norm(), 1e-15);
  }
  const std::uint64_t start = simulation.state().hash();
  simulation.step();
  simulation.reset();
  EXPECT_EQ(simulation.state().hash(), start);
}

TEST(InitialVelocity, NeedsInertia) {
  const std::string moving = "    velocity: {linear: 1 0 0 m/s}\n";
  expect_error(scene("", "quasi-static", moving), ErrorKind::conflicting_keys, "quasi-static", 10);
  EXPECT_NO_THROW(build(parsed(scene("", "quasi-static", "    velocity: {}\n"))));
}

}  // namespace
}  // namespace sinew::scene
