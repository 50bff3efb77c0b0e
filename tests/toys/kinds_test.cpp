// Kinds of bodies, actuators and controllers that the library does not know, in scenes.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "sinew/contact/contact_state.hpp"
#include "sinew/control/controller_observables.hpp"
#include "sinew/control/target_controller.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/model/model.hpp"
#include "sinew/record/run_file.hpp"
#include "sinew/record/run_recorder.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/state.hpp"
#include "sinew/scene/actuator_kind.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/controller_kind.hpp"
#include "sinew/scene/joint_kind.hpp"
#include "sinew/scene/load_kind.hpp"
#include "sinew/scene/material_kind.hpp"
#include "sinew/scene/probe_kind.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/scene/sensor_kind.hpp"
#include "sinew/sense/sensors.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state_io.hpp"

#include "scene_kinds.hpp"
#include "support/error_kind.hpp"

namespace sinew::testing {
namespace {

constexpr double kMass = 0.1, kStiffness = 50.0, kGravity = 9.81;
const Vector3 kAt{0.0, 0.0, 0.1}, kAnchor{0.1, 0.0, 0.1};  // m

scene::Robot robot(const std::string& command, const std::string& more = {},
                   const char* integrator = "quasi-static") {
  register_toys();
  const std::string text = fmt::format(
      "sinew: 1\ntime_step: 2 ms\nintegrator: {}\ngravity: 0 0 -9.81 m/s^2\n"
      "bodies: {{point: {{type: spring-point, at: 0 0 100 mm, mass: 100 g, stiffness: 50 N/m}}}}\n"
      "actuators: {{rod: {{type: strut, body: point, point: 0 0 100 mm, anchor: 100 0 100 mm, "
      "limits: {{pull: {{min: -5 N, max: 5 N}}}}, command: {{{}}}}}}}\n"
      "effectors: {{place: {{body: point, point: 0 0 100 mm}}}}\n{}",
      integrator, command, more);
  return scene::build(scene::parse_scene_text(text, "scene.yaml", {}));
}

Vector3 place(const sim::Simulation& simulation) { return simulation.body(0).position(0); }

TEST(Kinds, ABodyAndAnActuatorStandWhereTheirForcesBalance) {
  sim::Simulation simulation(robot("pull: 0.5 N").model);
  simulation.solve_static();
  const Vector3 p = place(simulation);
  const Vector3 force = kStiffness * (kAt - p) + Vector3(0.0, 0.0, -kMass * kGravity) +
                        0.5 * (kAnchor - p).normalized();
  EXPECT_LT(force.norm(), 1e-6);
  EXPECT_GT(p.x(), 0.009);
  EXPECT_EQ(simulation.model().actuators()[0].kind->word, std::string("strut"));
}

TEST(Kinds, AMotionIsHeldByWhateverEffortItTakes) {
  sim::Simulation simulation(robot("shortening: 4 mm").model);
  simulation.solve_static();
  const Vector3 p = place(simulation);
  EXPECT_NEAR((p - kAnchor).norm(), 0.096, 1e-9);
  const Vector3 held = kStiffness * (kAt - p) + Vector3(0.0, 0.0, -kMass * kGravity);
  EXPECT_NEAR(simulation.actuator(0).effort, held.norm(), 1e-6);
}

TEST(Kinds, LimitsOfItsQuantitiesHold) {
  sim::Simulation simulation(robot("shortening: 200 mm").model);
  simulation.step();
  EXPECT_LE(simulation.actuator(0).effort, 5.0 + 1e-9);
}

TEST(Kinds, RecordsAndObservablesHaveItsWordsAndUnits) {
  const scene::Robot made = robot("pull: 0.5 N");
  sim::Simulation simulation(made.model);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("sinew_kinds_{}", getpid());
  record::RecordSettings settings;
  settings.folder = folder;
  record::RunRecorder recorder(sim::Observables(simulation), settings);
  for (int k = 0; k < 3; ++k) {
    simulation.step();
    recorder.after_step();
  }
  recorder.finish();
  std::ostringstream table;
  table << std::ifstream(folder / "run.csv").rdbuf();
  EXPECT_NE(table.str().find("rod.pull [N]"), std::string::npos);
  EXPECT_NE(table.str().find("rod.shortening [m]"), std::string::npos);
  const record::RunFile file(folder / "run.h5");
  EXPECT_EQ(file.frames(), 4);
  EXPECT_EQ(Vector3(file.positions("point", 3).row(0)), place(simulation));
  std::filesystem::remove_all(folder);
}

// A finger of rubber, fixed at one end. @param more sections of the scene.
scene::Robot finger(const std::string& more, const char* integrator = "quasi-static") {
  register_toys();
  const std::string text = fmt::format(
      "sinew: 1\ntime_step: 2 ms\nintegrator: {}\nbodies: {{finger: {{type: fem, mesh: {{shape: "
      "block, length: 60 mm, width: 10 mm, height: 10 mm, element_size: 10 mm}}, material: "
      "{{young_modulus: 100 kPa, poisson_ratio: 0.3}}, density: 1000 kg/m^3, fixed: {{set: "
      "x_min}}}}}}\n{}",
      integrator, more);
  return scene::build(scene::parse_scene_text(text, "scene.yaml", {}));
}

Points at_rest(const std::string& loads) {
  sim::Simulation simulation(finger("loads: " + loads).model);
  simulation.solve_static();
  return simulation.body(0).positions();
}

TEST(Kinds, ALoadActsAsTheForcesOfWhichItConsists) {
  const Points moved = at_rest(
      "{turn: {type: couple, body: finger, first: 60 5 10 mm, second: 60 5 0 mm, force: 0.02 0 0 "
      "N, factor: 0.5}}");
  const Points forced = at_rest(
      "{up: {type: force, body: finger, point: 60 5 10 mm, force: 0.01 0 0 N}, "
      "down: {type: force, body: finger, point: 60 5 0 mm, force: -0.01 0 0 N}}");
  EXPECT_LT((moved - forced).norm(), 1e-12);
  EXPECT_GT((moved - at_rest("{}")).rowwise().norm().maxCoeff(), 1e-4);
}

TEST(Kinds, ASensorIsRecordedAndReadsTheSpeedOfItsPoint) {
  const scene::Robot made = finger(
      "loads: {turn: {type: couple, body: finger, first: 60 5 10 mm, second: 60 5 0 mm, force: "
      "0.02 0 0 N}}\n"
      "sensors: {speed: {type: speedometer, body: finger, at: 60 10 10 mm, delay: 2 ms}}\n",
      "bdf2");
  sim::Simulation simulation(made.model);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("sinew_speed_{}", getpid());
  record::RecordSettings settings;
  settings.folder = folder;
  record::RunRecorder recorder(sim::Observables(simulation), settings);
  for (int k = 0; k < 5; ++k) {
    simulation.step();
    recorder.after_step();
  }
  recorder.finish();
  std::ostringstream table;
  table << std::ifstream(folder / "sensors.csv").rdbuf();
  EXPECT_NE(table.str().find("speed.measured [m/s]"), std::string::npos) << table.str();
  std::filesystem::remove_all(folder);
  const Points& nodes = simulation.body(0).positions();
  Eigen::Index corner = 0;
  (nodes.rowwise() - Eigen::RowVector3d(0.06, 0.01, 0.01)).rowwise().norm().minCoeff(&corner);
  const double speed = simulation.body(0).velocities().row(corner).norm();
  EXPECT_GT(speed, 1e-3);
  EXPECT_NEAR(sense::sensors_of(simulation).truth(0)[0], speed, 1e-12);
}

TEST(Kinds, ASavedStateContinuesBitForBit) {
  const scene::Robot made = robot("pull: {sine: {amplitude: 0.5 N, period: 50 ms}}", {}, "bdf2");
  sim::Simulation first(made.model), second(made.model);
  for (int k = 0; k < 20; ++k) first.step();
  sim::parse_state(second, sim::format_state(first), "state");
  for (int k = 0; k < 20; ++k) {
    first.step();
    second.step();
  }
  EXPECT_EQ(place(first), place(second));
  EXPECT_NE(place(first), kAt);
}

TEST(Kinds, AFloorHoldsItAsAPoint) {
  sim::Simulation simulation(
      robot("pull: 0.2 N",
            "contacts: {floor: {body: point, points: [0 0 100 mm], surface: {plane: {point: 0 0 "
            "100 mm, normal: 0 0 1}}, friction: 0.5}}\n")
          .model);
  simulation.solve_static();
  EXPECT_NEAR(place(simulation).z(), 0.1, 1e-9);
  EXPECT_NEAR(place(simulation).x(), 0.0, 1e-6) << "0.2 N do not overcome friction";
  EXPECT_NEAR(simulation.contacts().point(0, 0).normal_force, kMass * kGravity, 1e-5);
}

TEST(Kinds, AControllerSteersABodyThroughAnActuatorThatItDoesNotKnow) {
  const scene::Robot made =
      robot("pull: 0 N",
            "controllers: {steer: {type: inverse, effectors: {place: {target: 5 0 80 mm, "
            "weight: 1 0 0}}}}\n");
  sim::Simulation simulation(made.model);
  const auto controller = control::make_controller(simulation, made.first_controller()->settings);
  for (int k = 0; k < 200; ++k) simulation.step();
  EXPECT_NEAR(place(simulation).x(), 0.005, 1e-6);
}

// Of the toys' own kind.
const std::string kFollow =
    "controllers: {follow: {type: proportional, effectors: {place: {target: 5 0 80 mm, weight: 1 0 "
    "0}}}}\n";

TEST(Kinds, AControllerOfItsOwnSteers) {
  const scene::Robot made = robot("pull: 0 N", kFollow);
  EXPECT_EQ(made.description.controllers[0].kind->word, std::string("proportional"));
  EXPECT_EQ(&made.controller("follow"), made.first_controller());
  sim::Simulation simulation(made.model);
  const auto controller = control::make_controller(simulation, made.first_controller()->settings);
  for (int k = 0; k < 100; ++k) simulation.step();
  EXPECT_NEAR(place(simulation).x(), 0.005, 1e-6);
  EXPECT_EQ(controller->status(), control::ControllerStatus::on_target);
  EXPECT_GT(controller->efforts()[0], 0.1) << "5 mm against 50 N/m";
  controller->set_target(0, control::Target::fixed({0.002, 0.0, 0.08}));
  for (int k = 0; k < 100; ++k) simulation.step();
  EXPECT_NEAR(place(simulation).x(), 0.002, 1e-6);
}

TEST(Kinds, AControllerOfItsOwnIsRecorded) {
  const scene::Robot made = robot("pull: 0 N", kFollow);
  sim::Simulation simulation(made.model);
  const auto controller = control::make_controller(simulation, made.first_controller()->settings);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("sinew_controller_{}", getpid());
  record::RecordSettings settings;
  settings.folder = folder;
  sim::Observables list(simulation);
  control::add_controller(list, controller.get());
  record::RunRecorder recorder(std::move(list), settings);
  for (int k = 0; k < 3; ++k) {
    simulation.step();
    recorder.after_step();
  }
  recorder.finish();
  const record::RunFile file(folder / "run.h5");
  EXPECT_EQ(file.series("/controller/follow/change").size(), 4U);
  std::ostringstream table;
  table << std::ifstream(folder / "run.csv").rdbuf();
  for (const char* heading : {"follow.change [N]", "place.error [m]", "controller"}) {
    EXPECT_NE(table.str().find(heading), std::string::npos) << heading;
  }
  EXPECT_NE(table.str().find("moving"), std::string::npos);
  std::filesystem::remove_all(folder);
}

TEST(Kinds, AControllerOfItsOwnGoesOnBitForBit) {
  const scene::Robot made = robot("pull: 0 N", kFollow, "bdf2");
  sim::Simulation first(made.model);
  const auto controller = control::make_controller(first, made.first_controller()->settings);
  controller->set_target(0, control::Target::fixed({0.004, 0.0, 0.08}));
  for (int k = 0; k < 10; ++k) first.step();
  const auto copy = first.clone();
  const auto again = control::make_controller(*copy, controller->all_settings());
  copy->restore(first.state());
  sim::Simulation read(made.model);
  const auto other = control::make_controller(read, controller->all_settings());
  sim::parse_state(read, sim::format_state(first), "state");
  EXPECT_EQ(again->status(), controller->status());
  for (int k = 0; k < 10; ++k) {
    first.step();
    copy->step();
    read.step();
  }
  EXPECT_EQ(copy->state(), first.state());
  EXPECT_EQ(read.state(), first.state());
  first.reset();
  EXPECT_EQ(controller->status(), control::ControllerStatus::not_started);
}

TEST(Kinds, ErrorsNameItsKeys) {
  try {
    robot("tension: 1 N");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::unknown_key);
    EXPECT_NE(std::string(error.what()).find("shortening"), std::string::npos) << error.what();
  }
}

TEST(Kinds, AreRegisteredBeforeTheGrammarIsUsed) {
  robot("pull: 0 N");
  static const scene::BodyKind late{.word = "late"};
  EXPECT_EQ(kind_of([] { scene::register_body_kind(late); }), ErrorKind::bad_argument);
  static constexpr model::ActuatorKind words{.word = "late"};
  static const scene::ActuatorKind late_actuator{.words = &words};
  static const scene::SensorKind late_sensor{.word = "late"};
  static const scene::LoadKind late_load{.word = "late"};
  static const scene::ProbeKind late_probe{.word = "late"};
  static const scene::JointKind late_joint{.word = "late"};
  static const scene::MaterialKind late_material{.word = "late"};
  EXPECT_EQ(kind_of([] { scene::register_actuator_kind(late_actuator); }), ErrorKind::bad_argument);
  EXPECT_EQ(kind_of([] { scene::register_sensor_kind(late_sensor); }), ErrorKind::bad_argument);
  EXPECT_EQ(kind_of([] { scene::register_load_kind(late_load); }), ErrorKind::bad_argument);
  EXPECT_EQ(kind_of([] { scene::register_probe_kind(late_probe); }), ErrorKind::bad_argument);
  EXPECT_EQ(kind_of([] { scene::register_joint_kind(late_joint); }), ErrorKind::bad_argument);
  EXPECT_EQ(kind_of([] { scene::register_material_kind(late_material); }), ErrorKind::bad_argument);
  static const scene::ControllerKind late_controller{.word = "late"};
  EXPECT_EQ(kind_of([] { scene::register_controller_kind(late_controller); }),
            ErrorKind::bad_argument);
}

TEST(Kinds, WordsAreTakenOnce) {
  register_toys();
  EXPECT_EQ(kind_of([] { scene::register_body_kind(scene::fem_kind()); }),
            ErrorKind::duplicate_key);
  EXPECT_EQ(kind_of([] { scene::register_actuator_kind(scene::cable_kind()); }),
            ErrorKind::duplicate_key);
  EXPECT_EQ(kind_of([] { scene::register_sensor_kind(scene::touch_kind()); }),
            ErrorKind::duplicate_key);
  EXPECT_EQ(kind_of([] { scene::register_load_kind(scene::water_kind()); }),
            ErrorKind::duplicate_key);
  EXPECT_EQ(kind_of([] { scene::register_probe_kind(scene::bend_probe_kind()); }),
            ErrorKind::duplicate_key);
  EXPECT_EQ(kind_of([] { scene::register_joint_kind(scene::hinge_kind()); }),
            ErrorKind::duplicate_key);
  EXPECT_EQ(kind_of([] { scene::register_material_kind(scene::yeoh_kind()); }),
            ErrorKind::duplicate_key);
  EXPECT_EQ(kind_of([] { scene::register_controller_kind(scene::inverse_kind()); }),
            ErrorKind::duplicate_key);
}

}  // namespace
}  // namespace sinew::testing
