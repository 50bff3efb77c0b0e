// Contacts of scenes: reading, building, and invalid scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/shape_contact.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/model.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::scene {
namespace {

using K = ErrorKind;

const std::string kBlock = R"(sinew: 1
integrator: backward-euler
time_step: 1 ms
bodies:
  block:
    type: fem
    mesh: {shape: block, length: 40 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}
    material: {young_modulus: 100 kPa, poisson_ratio: 0.4}
    density: 1000 kg/m^3
contacts:
)";

SceneDescription scene_with(const std::string& contact) {
  return parse_scene_text(kBlock + "  c: " + contact + "\n", "scene.yaml", {});
}

std::size_t points_of(const std::string& contact) {
  return build(scene_with(contact)).model->contact(0).size();
}

void expect_error(const std::string& contact, ErrorKind kind, const std::string& words) {
  try {
    build(scene_with(contact));
    ADD_FAILURE() << contact << " was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_EQ(error.place().line, 11) << error.what();
    EXPECT_THAT(error.what(), testing::HasSubstr(words));
  }
}

TEST(Contacts, PickNodesOfTheOutside) {
  EXPECT_EQ(points_of("{body: block, surface: {plane: {point: 0 0 -5 mm}}}"), 5u * 9u - 3u);
  EXPECT_EQ(points_of("{body: block, surface: {plane: {}}, nodes: {set: z_min}}"), 15u);
  EXPECT_EQ(points_of("{body: block, surface: {plane: {}}, nodes: {box: 0 0 0 10 20 0 mm}}"), 6u);
  EXPECT_EQ(points_of("{body: block, surface: {plane: {}}, nodes: [{box: 0 0 0 10 20 0 mm}, "
                      "{box: 0 0 0 20 10 0 mm}, {box: 40 0 0 40 20 0 mm}]}"),
            11u);
  EXPECT_EQ(points_of("{body: block, surface: {plane: {}}, points: [5 5 0 mm, 6 5 0 mm]}"), 2u);
}

TEST(Contacts, ReadEverySurfaceAndItsMotion) {
  const auto sphere = scene_with(
      "{body: block, surface: {sphere: {centre: 0 0 -10 mm, radius: 5 mm}}, friction: 0.7}");
  EXPECT_DOUBLE_EQ(std::get<constraint::Sphere>(sphere.contacts[0].surface).radius, 0.005);
  EXPECT_DOUBLE_EQ(std::get<constraint::Sphere>(sphere.contacts[0].surface).centre[2], -0.01);
  EXPECT_DOUBLE_EQ(sphere.contacts[0].friction, 0.7);
  const auto capsule = scene_with(
      "{body: block, surface: {capsule: {ends: [0 0 -10 mm, 40 0 -12 mm], radius: 5 mm}}, "
      "motion: {z: {ramp: {to: 4 mm, duration: 2 s}}, angle: 0.1, axis: 0 2 0}}");
  const auto& shape = std::get<constraint::Capsule>(capsule.contacts[0].surface);
  EXPECT_DOUBLE_EQ(shape.to[0], 0.04);
  EXPECT_DOUBLE_EQ(shape.to[2], -0.012);
  EXPECT_DOUBLE_EQ(capsule.contacts[0].motion->translation[2].value(1.0), 0.002);
  EXPECT_DOUBLE_EQ(capsule.contacts[0].motion->axis[1], 1.0);
  EXPECT_DOUBLE_EQ(capsule.run_duration(), 2.0);
  const auto plane = scene_with("{body: block, surface: {plane: {normal: 0 0 3}}}");
  EXPECT_DOUBLE_EQ(std::get<constraint::Plane>(plane.contacts[0].surface).normal[2], 1.0);
}

TEST(Contacts, SayWhatIsWrong) {
  expect_error("{body: blok, surface: {plane: {}}}", K::unknown_name, "blok");
  expect_error("{body: block, surface: {}}", K::missing_key, "plane");
  expect_error("{body: block, surface: {plane: {}, capsule: {ends: [0 0 0, 0 0 1], radius: 1}}}",
               K::conflicting_keys, "capsule");
  expect_error("{body: block, surface: {plane: {normal: 0 0 0}}}", K::out_of_range, "0");
  expect_error("{body: block, surface: {sphere: {centre: 0 0 0, radius: 0 mm}}}", K::out_of_range,
               "radius");
  expect_error("{body: block, surface: {plane: {}}, friction: -0.5}", K::out_of_range, "-0.5");
  expect_error("{body: block, surface: {plane: {}}, nodes: {set: z_mim}}", K::unknown_set, "z_m");
  expect_error("{body: block, surface: {plane: {}}, nodes: {set: z_min}, points: [0 0 0]}",
               K::conflicting_keys, "points");
  expect_error("{body: block, surface: {plane: {}}, nodes: {box: 10 10 10 10 10 10 mm}}",
               K::empty_region, "inside");
  expect_error("{body: block, surface: {plane: {}}, nodes: [{set: z_min}, {set: z_mim}]}",
               K::unknown_set, "z_m");
  expect_error("{body: block, surface: {plane: {}}, nodes: []}", K::empty_list, "set");
  expect_error("{body: block, surface: {plane: {}}, points: [0 0 -90 mm]}", K::point_outside_mesh,
               "point 0");
  expect_error("{body: block, surface: {plane: {point: 0 0 10 mm}}}", K::out_of_range, "inside");
}

const std::string kPlanes = R"(sinew: 1
integrator: backward-euler
time_step: 1 ms
bodies:
  wall: {type: rigid, shape: {plane: {}}, motion: {x: {ramp: {to: 4 mm, duration: 2 s}}}, pose: {position: -50 0 0 mm, rotation: {axis: 0 1 0, angle: 90 deg}}}
  block:
    type: fem
    mesh: {shape: block, length: 40 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}
    material: {young_modulus: 100 kPa, poisson_ratio: 0.4}
    density: 1000 kg/m^3
  box: {type: rigid, shape: {box: 10 10 10 mm}, density: 1000 kg/m^3, pose: {position: 80 0 10 mm}}
  base: {type: rigid, shape: {box: 10 10 10 mm}, fixed: true, pose: {position: 120 0 10 mm}}
  floor: {type: rigid, shape: {plane: {}}, fixed: true}
contacts:
)";

TEST(Contacts, TouchPlanesThatAreBodies) {
  const auto scene = parse_scene_text(kPlanes +
                                          "  all: {between: all, friction: 0.3, aggregate: 5 mm, "
                                          "except: [[box, wall]]}\n",
                                      "scene.yaml", {});
  EXPECT_DOUBLE_EQ(scene.run_duration(), 2.0);
  const Robot robot = build(scene);
  EXPECT_EQ(robot.model->bodies().size(), 3u);
  std::vector<std::string> names;
  for (const model::ContactModel& contact : robot.model->contacts()) names.push_back(contact.name);
  EXPECT_THAT(names, testing::UnorderedElementsAre(
                         "all-block-block", "all-block-box", "all-block-base", "all-box-base",
                         "all-block-wall", "all-block-floor", "all-box-floor"));
  const int wall = robot.model->contact_index("all-block-wall");
  const auto& on_wall = dynamic_cast<const constraint::ShapeContact&>(robot.model->contact(wall));
  const auto& plane = std::get<constraint::Plane>(on_wall.surface());
  EXPECT_LT((plane.normal - Vector3::UnitX()).norm(), 1e-15);
  EXPECT_LT((plane.point - Vector3(-0.05, 0.0, 0.0)).norm(), 1e-15);
  const auto& model = robot.model->contacts()[static_cast<std::size_t>(wall)];
  EXPECT_LT((model.pose(1.0).translation() - Vector3(0.002, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_GT(model.aggregate, 0.0);
}

TEST(Contacts, OfPlanesThatAreBodiesSayWhatIsWrong) {
  const auto expect = [](const std::string& text, ErrorKind kind, const std::string& words) {
    try {
      build(parse_scene_text(text, "scene.yaml", {}));
      ADD_FAILURE() << text << " was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      EXPECT_GT(error.place().line, 0) << error.what();
      EXPECT_THAT(error.what(), testing::HasSubstr(words));
    }
  };
  const std::string planes = kPlanes;
  expect(planes + "  c: {between: [floor, wall]}\n", K::conflicting_keys, "both planes");
  expect(planes + "  c: {between: [floor, box]}\n  d: {between: [box, floor]}\n",
         K::conflicting_keys, "have a contact already");
  expect(planes + "  c: {body: floor, surface: {plane: {}}}\n", K::wrong_type, "only contacts");
  expect(planes + "  c: {between: [box, floor]}\njoints: {j: {type: weld, bodies: [box, wall]}}\n",
         K::wrong_type, "only contacts");
  const auto replaced = [&](const std::string& by) {
    std::string text = planes + "  c: {between: [box, floor]}\n";
    const std::string from = "floor: {type: rigid, shape: {plane: {}}, fixed: true}";
    return text.replace(text.find(from), from.size(), by);
  };
  expect(replaced("floor: {type: rigid, shape: {plane: {}}}"), K::conflicting_keys, "freely");
  expect(replaced("floor: {type: rigid, shape: {plane: {}}, fixed: false, motion: {z: 1 mm}}"),
         K::conflicting_keys, "free");
  expect(replaced("floor: {type: rigid, shape: {plane: {}}, fixed: true, mass: 1 kg}"),
         K::conflicting_keys, "mass");
  expect(replaced("floor: {type: rigid, shape: {plane: {normal: 0 0 1}}, fixed: true}"),
         K::unknown_key, "normal");
}

TEST(Contacts, StandBesideControllers) {
  const std::string text = kBlock +
                           "  c: {body: block, surface: {plane: {}}}\n"
                           "actuators:\n"
                           "  push: {type: force, body: block, point: 0 0 0, direction: 1 0 0}\n"
                           "effectors:\n"
                           "  tip: {body: block, point: 0 0 0}\n"
                           "controllers:\n"
                           "  follow: {type: inverse, effectors: {tip: {target: 0 0 0}}}\n";
  const Robot robot = build(parse_scene_text(text, "scene.yaml", {}));
  EXPECT_EQ(robot.model->contacts().size(), 1);
  EXPECT_EQ(robot.controllers.size(), 1);
}

}  // namespace
}  // namespace sinew::scene
