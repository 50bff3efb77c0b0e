#include "sinew/scene/scene.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/mesh/embedding.hpp"
#include "sinew/scene/actuator_kind.hpp"

#include "scene_fixture.hpp"

namespace sinew::scene {
namespace {

TEST(Scene, TheDocumentedExampleParsesAsWritten) {
  const SceneFolder folder;
  folder.write("trunk.vtk", "# vtk DataFile Version 3.0\n");
  folder.write("long_0.csv", "0, 10, 0\n0, 10, 21\n0, 11, 27\n");
  folder.write("trunk.yaml", kExample);
  const SceneDescription scene = parse_scene(folder.path() / "trunk.yaml");

  EXPECT_EQ(scene.name, "trunk");
  EXPECT_EQ(scene.version, 1);
  EXPECT_EQ(scene.gravity, Vector3::Zero().eval());
  EXPECT_DOUBLE_EQ(scene.time_step, 0.01);
  EXPECT_EQ(scene.integrator, Integrator::quasi_static);

  ASSERT_EQ(scene.bodies.size(), 1u);
  const BodyDescription& body = scene.bodies[0];
  EXPECT_EQ(body.name, "trunk");
  EXPECT_EQ(body.mesh.file, folder.path() / "trunk.vtk");
  EXPECT_DOUBLE_EQ(body.mesh.unit, 1e-3);
  EXPECT_EQ(body.material.model, MaterialModel::corotational);
  EXPECT_DOUBLE_EQ(body.material.young_modulus, 450e3);
  EXPECT_DOUBLE_EQ(body.material.poisson_ratio, 0.45);
  EXPECT_DOUBLE_EQ(body.mass.value(), 0.042);
  EXPECT_FALSE(body.density.has_value());
  EXPECT_DOUBLE_EQ(body.mass_damping, 0.1);
  EXPECT_DOUBLE_EQ(body.stiffness_damping, 0.01);
  ASSERT_EQ(body.fixed.size(), 1u);
  EXPECT_EQ(body.fixed[0].kind, FixedRegion::Kind::box);
  EXPECT_LT((body.fixed[0].lower - Vector3(-0.02, -0.02, 0)).norm(), 1e-15);
  EXPECT_LT((body.fixed[0].upper - Vector3(0.02, 0.02, 0.02)).norm(), 1e-15);

  ASSERT_EQ(scene.actuators.size(), 1u);
  const ActuatorDescription& actuator = scene.actuators[0];
  EXPECT_EQ(actuator.name, "long_0");
  EXPECT_EQ(actuator.kind, &cable_kind());
  EXPECT_EQ(actuator.body, "trunk");
  const auto& cable = actuator.as<CableDescription>()[0].settings;
  ASSERT_EQ(cable.points.rows(), 3);
  EXPECT_LT((cable.points.row(2) - Vector3(0, 0.011, 0.027).transpose()).norm(), 1e-15);
  EXPECT_EQ(cable.point_places[1].line, 2);
  EXPECT_THAT(cable.point_places[1].file, testing::EndsWith("long_0.csv"));
  EXPECT_TRUE(cable.pull_from_world);
  EXPECT_EQ(cable.outside, mesh::Outside::nearest);
  EXPECT_EQ(cable.tension.min, 0.0);
  EXPECT_EQ(cable.tension.max, 20.0);
  EXPECT_EQ(cable.tension.rate, kInfinity);
  EXPECT_EQ(cable.displacement.min, 0.0);
  EXPECT_DOUBLE_EQ(cable.displacement.max, 0.07);
  EXPECT_DOUBLE_EQ(cable.displacement.rate, 0.1);
  EXPECT_EQ(actuator.command.kind, model::CommandKind::motion);
  EXPECT_EQ(actuator.command.signal.value(1.0), 0.0);

  ASSERT_EQ(scene.effectors.size(), 1u);
  EXPECT_EQ(scene.effectors[0].kind, EffectorDescription::Kind::point);
  EXPECT_LT((scene.effectors[0].points.points.row(0) - Vector3(0, 0, 0.195).transpose()).norm(),
            1e-15);
  EXPECT_EQ(scene.effectors[0].directions, Points(Matrix3::Identity()));

  ASSERT_EQ(scene.controllers.size(), 1u);
  const ControllerDescription& controller = scene.controllers[0];
  EXPECT_TRUE(controller.actuators.empty());
  ASSERT_EQ(controller.tasks.size(), 1u);
  EXPECT_EQ(controller.tasks[0].effector, "tip");
  EXPECT_LT((controller.tasks[0].target.at(2.5) - Vector3(0, 0.03, 0.19)).norm(), 1e-15);
  EXPECT_EQ(scene.record.every, 1);
  EXPECT_TRUE(scene.record.states);
  EXPECT_EQ(scene.run_duration(), 10.0);
}

TEST(Scene, PlacesNameLineColumnAndPath) {
  const SceneDescription scene = parse(kExample);
  EXPECT_EQ(scene.bodies[0].mass_place.text(), "scene.yaml:11:11: bodies.trunk.mass");
  EXPECT_EQ(scene.bodies[0].mesh.place.text(), "scene.yaml:8:18: bodies.trunk.mesh.file");
  EXPECT_EQ(scene.effectors[0].points.places[0].text(), "scene.yaml:24:29: effectors.tip.point");
}

TEST(Scene, NumbersWithoutUnitsAreSi) {
  const SceneDescription scene = parse_edited({{"time_step: 10 ms", "time_step: 0.02"},
                                               {"gravity: 0 0 0 m/s^2", "gravity: [0, 0, -9.81]"},
                                               {"point: 0 0 195 mm", "point: [0, 0, 195 mm]"}});
  EXPECT_EQ(scene.time_step, 0.02);
  EXPECT_EQ(scene.gravity, Vector3(0, 0, -9.81));
  EXPECT_DOUBLE_EQ(scene.effectors[0].points.points(0, 2), 0.195);
}

TEST(Scene, OrderOfTheFileIsKept) {
  const SceneDescription scene =
      parse_edited({{"  tip: {body: trunk, point: 0 0 195 mm}",
                     "  tip: {body: trunk, point: 0 0 195 mm}\n  a: {body: trunk, set: 3}\n"
                     "  m: {body: trunk, points: [0 0 1 mm, 0 0 2 mm]}"}});
  ASSERT_EQ(scene.effectors.size(), 3u);
  EXPECT_EQ(scene.effectors[1].name, "a");
  EXPECT_EQ(scene.effectors[1].kind, EffectorDescription::Kind::set);
  EXPECT_EQ(scene.effectors[1].set, "3");
  EXPECT_EQ(scene.effectors[2].kind, EffectorDescription::Kind::points);
  EXPECT_EQ(scene.effectors[2].points.points.rows(), 2);
}

TEST(Scene, EveryFixedRegionIsRead) {
  const SceneDescription scene = parse_edited(
      {{"fixed: {box: -20 -20 0 20 20 20 mm}",
        "fixed:\n      - {box: 0 0 0 1 1 1}\n      - {sphere: {centre: 1 2 3 mm, radius: 1 cm}}\n"
        "      - {plane: {point: 0 0 1, normal: 0 0 5, within: 0.1 mm}}\n      - {set: base}"}});
  ASSERT_EQ(scene.bodies[0].fixed.size(), 4u);
  const auto& fixed = scene.bodies[0].fixed;
  EXPECT_EQ(fixed[1].kind, FixedRegion::Kind::sphere);
  EXPECT_DOUBLE_EQ(fixed[1].radius, 0.01);
  EXPECT_DOUBLE_EQ(fixed[1].point.y(), 0.002);
  EXPECT_EQ(fixed[2].kind, FixedRegion::Kind::plane);
  EXPECT_EQ(fixed[2].normal, Vector3::UnitZ().eval());
  EXPECT_DOUBLE_EQ(fixed[2].within, 1e-4);
  EXPECT_EQ(fixed[3].set, "base");
  EXPECT_EQ(fixed[3].place.line, 17);
}

TEST(Scene, ShapesKeepTheirParameters) {
  const SceneDescription scene = parse_edited(
      {{"{file: trunk.vtk, unit: mm}",
        "{shape: hollow-cylinder, inner_radius: 8 mm, outer_radius: 15 mm, height: 0.2}"}});
  EXPECT_EQ(scene.bodies[0].mesh.shape, "hollow-cylinder");
  EXPECT_TRUE(scene.bodies[0].mesh.file.empty());
  EXPECT_EQ(scene.bodies[0].mesh.parameters.size(), 3u);
  EXPECT_DOUBLE_EQ(scene.bodies[0].mesh.parameters.at("outer_radius"), 0.015);
}

TEST(Scene, EverySignalIsRead) {
  const auto signal = [](const std::string& command) {
    return parse_edited({{"command: {displacement: 0 mm}", "command: {" + command + "}"}})
        .actuators[0]
        .command;
  };
  EXPECT_DOUBLE_EQ(signal("tension: 2 N").signal.value(0), 2.0);
  EXPECT_EQ(signal("tension: 2 N").kind, model::CommandKind::effort);
  const auto ramp = signal("displacement: {ramp: {to: 10 mm, start: 1 s, duration: 2 s}}").signal;
  EXPECT_DOUBLE_EQ(ramp.value(2.0), 0.005);
  EXPECT_DOUBLE_EQ(ramp.end_time(), 3.0);
  const auto sine =
      signal("displacement: {sine: {amplitude: 10 mm, frequency: 0.5 Hz, phase: 90 deg}}").signal;
  EXPECT_NEAR(sine.value(1.0), -0.01, 1e-15);
  const auto steps = signal("displacement: {steps: [[0, 0], [100 ms, 3 mm]]}").signal;
  EXPECT_DOUBLE_EQ(steps.value(0.1), 0.003);
}

TEST(Scene, SignalsAndTargetsComeFromTables) {
  const SceneFolder folder;
  folder.write("trunk.vtk", "x");
  folder.write("long_0.csv", "0, 10, 0\n0, 10, 21\n");
  folder.write("pull.csv", "time,value\n0,0\n1,10\n");
  folder.write("path.csv", "0,0,0,190\n2,10,0,190\n");
  const std::string text =
      edited({{"{displacement: 0 mm}", "{displacement: {file: pull.csv, unit: mm}}"},
              {"{circle: {centre: 0 0 190 mm, radius: 30 mm, normal: 0 0 1, period: 10 s}}",
               "{file: path.csv, unit: mm}"}});
  const SceneDescription scene = parse_scene_text(text, "s.yaml", folder.path());
  EXPECT_DOUBLE_EQ(scene.actuators[0].command.signal.value(0.5), 0.005);
  EXPECT_LT((scene.controllers[0].tasks[0].target.at(1.0) - Vector3(0.005, 0, 0.19)).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(scene.run_duration(), 2.0);
}

TEST(Scene, SignalsTakeAColumnByItsHeading) {
  const SceneFolder folder;
  folder.write("trunk.vtk", "x");
  folder.write("long_0.csv", "0, 10, 0\n0, 10, 21\n");
  folder.write("pull.csv", "time [s],first [cm],second [mm],third\n0,0,0,0\n1,7,10,2\n");
  const auto at_half = [&](const std::string& file) {
    const std::string text =
        edited({{"{displacement: 0 mm}", "{displacement: {file: pull.csv, " + file + "}}"}});
    return parse_scene_text(text, "s.yaml", folder.path()).actuators[0].command.signal.value(0.5);
  };
  EXPECT_DOUBLE_EQ(at_half("column: second"), 0.005);
  EXPECT_DOUBLE_EQ(at_half("column: 'second [mm]'"), 0.005);
  EXPECT_DOUBLE_EQ(at_half("column: first"), 0.035);
  EXPECT_DOUBLE_EQ(at_half("column: third, unit: mm"), 0.001);
  EXPECT_DOUBLE_EQ(at_half("column: third"), 1.0);
}

// With or without `column`, and in every spelling, a table means the same.
TEST(Scene, TablesHaveUnitsInTheirHeadings) {
  const SceneFolder folder;
  folder.write("trunk.vtk", "x");
  folder.write("long_0.csv", "x [mm] y [mm] z [cm]\n0 10 0\n0 10 2.1\n");
  folder.write("path.csv", "# t [ms],x [mm],y [m],z [cm]\n0,0,0,19\n2000,10,0,19\n");
  for (const char* pull :
       {"time [ms],pull [mm]\n0,0\n1000,10\n", "time (s),pull (cm)\n0,0\n1,1\n",
        "time_ms,pull_mm\n0,0\n1000,10\n", "t [min],pull\n0,0\n1,0.6\n", "0,0\n1,0.01\n"}) {
    folder.write("pull.csv", pull);
    const std::string text =
        edited({{"{displacement: 0 mm}", "{displacement: {file: pull.csv}}"},
                {"{file: long_0.csv, unit: mm}", "{file: long_0.csv}"},
                {"{circle: {centre: 0 0 190 mm, radius: 30 mm, normal: 0 0 1, period: 10 s}}",
                 "{file: path.csv}"}});
    const SceneDescription scene = parse_scene_text(text, "s.yaml", folder.path());
    EXPECT_DOUBLE_EQ(scene.actuators[0].command.signal.value(0.5), 0.005) << pull;
    EXPECT_LT((scene.controllers[0].tasks[0].target.at(1.0) - Vector3(0.005, 0, 0.19)).norm(),
              1e-15);
    const auto& cable = *scene.actuators[0].as<CableDescription>();
    EXPECT_LT((cable.settings.points.row(1) - Eigen::RowVector3d(0, 0.01, 0.021)).norm(), 1e-15);
  }
}

TEST(Scene, PolylinesTakeASpeedOrAPeriod) {
  const SceneDescription scene = parse_edited(
      {{"{circle: {centre: 0 0 190 mm, radius: 30 mm, normal: 0 0 1, period: 10 s}}",
        "{polyline: {points: [0 0 190 mm, 20 0 190 mm], speed: 10 mm/s, closed: true}}"}});
  EXPECT_DOUBLE_EQ(scene.controllers[0].tasks[0].target.end_time(), 4.0);
}

TEST(Scene, OrientationsAreAskedForARotation) {
  const SceneDescription scene = parse_edited(
      {{"point: 0 0 195 mm", "orientation: [0 0 190 mm, 10 0 190 mm, 0 10 190 mm]"},
       {"{target: {circle: {centre: 0 0 190 mm, radius: 30 mm, normal: 0 0 1, period: 10 s}}}",
        "{rotation: 0 0 90 deg, weight: 1 1 0}"}});
  EXPECT_EQ(scene.effectors[0].kind, EffectorDescription::Kind::orientation);
  EXPECT_NEAR(scene.controllers[0].tasks[0].target.at(0).z(), 1.5707963267948966, 1e-15);
  EXPECT_THAT(scene.controllers[0].tasks[0].weights, testing::ElementsAre(1, 1, 0));
}

TEST(Scene, DirectionsAreAxesOrVectors) {
  const SceneDescription scene =
      parse_edited({{"{body: trunk, point: 0 0 195 mm}",
                     "{body: trunk, point: 0 0 195 mm, directions: [z, 3 4 0]}"}});
  ASSERT_EQ(scene.effectors[0].directions.rows(), 2);
  EXPECT_EQ(scene.effectors[0].directions.row(0), Vector3::UnitZ().transpose().eval());
  EXPECT_LT((scene.effectors[0].directions.row(1) - Vector3(0.6, 0.8, 0).transpose()).norm(),
            1e-15);
}

TEST(Scene, ForceActuatorsAreRead) {
  const SceneDescription scene = parse_edited(
      {{"effectors:\n",
        "  push: {type: force, body: trunk, point: 0 0 195 mm, direction: 2 0 0, limits: {force: "
        "{min: -1 N}}, command: {force: 0.5 N}}\neffectors:\n"}});
  ASSERT_EQ(scene.actuators.size(), 2u);
  const ActuatorDescription& actuator = scene.actuators[1];
  EXPECT_EQ(actuator.kind, &force_kind());
  const auto& force = *actuator.as<builder::ForceSettings>();
  EXPECT_EQ(force.direction, Vector3::UnitX().eval());
  EXPECT_EQ(force.force.min, -1.0);
  EXPECT_EQ(actuator.command.signal.value(0), 0.5);
}

TEST(Scene, SolverMayBeAWordOrAMap) {
  EXPECT_EQ(parse_edited({{"record:", "solver: newton\nrecord:"}}).solver.method, Method::newton);
  const SolverDescription solver =
      parse_edited({{"record:",
                     "solver: {method: newton, tangent: exact, tolerance: 1e-6, max_iterations: 7, "
                     "contact_tolerance: 1e-7, threads: 4, factorisation: block, ordering: "
                     "metis}\nrecord:"}})
          .solver;
  EXPECT_EQ(solver.method, Method::newton);
  EXPECT_EQ(solver.tangent, Tangent::exact);
  EXPECT_EQ(solver.tolerance, 1e-6);
  EXPECT_EQ(solver.max_iterations, 7);
  EXPECT_EQ(solver.contact_tolerance, 1e-7);
  EXPECT_EQ(solver.threads, 4);
  EXPECT_EQ(solver.backend, "block");
  EXPECT_EQ(solver.ordering, linalg::Ordering::metis);
}

TEST(Scene, ATreeMadeByHandIsReadTheSame) {
  Node tree = parse_yaml(kExample, "scene.yaml");
  Node& body = *tree.find("bodies")->find("trunk");
  body.set("mass", Node::number(0.05));
  Node fixed = Node::map();
  Node box = Node::list();
  for (const double x : {-0.02, -0.02, 0.0, 0.02, 0.02, 0.02}) box.append(Node::number(x));
  fixed.set("box", std::move(box));
  body.set("fixed", std::move(fixed));
  const SceneDescription scene = parse_scene_tree(tree, {}, Files::ignore);
  EXPECT_EQ(scene.bodies[0].mass.value(), 0.05);
  EXPECT_EQ(scene.bodies[0].fixed[0].lower.x(), -0.02);
  EXPECT_EQ(scene.bodies[0].mass_place.item, "bodies.trunk.mass");
}

TEST(Scene, WritingATreeBackGivesTheSameScene) {
  const SceneDescription scene = parse(kExample);
  const std::string written = to_yaml(scene.tree);
  const SceneDescription again = parse(written);
  EXPECT_TRUE(again.tree == scene.tree);
  EXPECT_EQ(to_yaml(again.tree), written);
}

TEST(Scene, PathsBecomeAbsolute) {
  Node tree = parse_yaml(kExample, "scene.yaml");
  resolve_paths(tree, "/somewhere/else");
  EXPECT_EQ(tree.find("bodies")->find("trunk")->find("mesh")->find("file")->spelling(),
            "/somewhere/else/trunk.vtk");
  EXPECT_EQ(tree.find("actuators")->find("long_0")->find("points")->find("file")->spelling(),
            "/somewhere/else/long_0.csv");
}

}  // namespace
}  // namespace sinew::scene
