// Probes of scenes: reading, building, and invalid scenes.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::scene {
namespace {

const std::string kBlocks = R"(sinew: 1
bodies:
  low:
    type: fem
    mesh: {shape: block, length: 60 mm, width: 20 mm, height: 10 mm, element_size: 5 mm}
    material: {young_modulus: 100 kPa, poisson_ratio: 0.4}
    density: 1000 kg/m^3
    fixed: {set: x_min}
  high:
    type: fem
    mesh: {shape: block, length: 30 mm, width: 20 mm, height: 10 mm, element_size: 5 mm}
    material: {young_modulus: 100 kPa, poisson_ratio: 0.4}
    density: 1000 kg/m^3
    fixed: {set: x_min}
probes:
)";

sim::Simulation simulation_with(const std::string& probe) {
  const std::string text = kBlocks + "  p: " + probe + "\n";
  return sim::Simulation(build(parse_scene_text(text, "scene.yaml", {})).model);
}

std::vector<double> at_rest(const std::string& probe) {
  return simulation_with(probe).probe_values(0);
}

TEST(Probes, AreBuiltAsTheSceneSays) {
  using testing::DoubleNear;
  using testing::ElementsAre;
  const auto is = [](double value) { return DoubleNear(value, 1e-9); };
  EXPECT_THAT(at_rest("{body: low, point: 10 5 2 mm}"),
              ElementsAre(is(0.01), is(0.005), is(0.002)));
  EXPECT_THAT(at_rest("{body: low, points: [0 0 0 mm, 60 20 10 mm]}"),
              ElementsAre(is(0.03), is(0.01), is(0.005)));
  EXPECT_THAT(at_rest("{body: low, set: x_max}"),
              ElementsAre(is(0.06), DoubleNear(0.01, 1e-3), DoubleNear(0.005, 1e-3)));
  EXPECT_THAT(at_rest("{body: low, line: [0 0 0 mm, 60 0 0 mm, 60 0 10 mm], samples: 2}"),
              ElementsAre(is(0.07), is(0), is(0), is(0), is(0.06), is(0), is(0), is(0.06), is(0),
                          is(0.01)));
  EXPECT_EQ(at_rest("{body: low, line: [0 0 0 mm, 60 0 0 mm]}").size(), 1 + 3 * 21u);
  EXPECT_THAT(at_rest("{body: low, bend: [{set: x_min}, {set: z_max}], about: y}"),
              ElementsAre(is(-std::numbers::pi / 2)));
  EXPECT_THAT(at_rest("{body: low, bend: [{set: x_min}, {plane: {point: 30 0 0 mm, normal: -1 0 0, "
                      "within: 6 mm}}]}"),
              ElementsAre(DoubleNear(0.0, 1e-7)));
  EXPECT_THAT(at_rest("{body: low, distance: [0 0 0 mm, {body: high, point: 30 0 0 mm}]}"),
              ElementsAre(is(0.03)));
  EXPECT_THAT(at_rest("{body: high, extent: {along: x}}"), ElementsAre(is(0.03)));
  EXPECT_THAT(at_rest("{body: low, extent: {box: 0 0 0 20 20 10 mm, along: [3, 0, 4]}}"),
              ElementsAre(is(0.6 * 0.02 + 0.8 * 0.01)));
  EXPECT_THAT(at_rest("{body: low, extent: {set: x_max, across: x}}"),
              ElementsAre(is(std::hypot(0.02, 0.01))));
  EXPECT_THAT(at_rest("{body: low, extent: {set: x_max, across: x, size: smallest}}"),
              ElementsAre(is(0.01)));
  EXPECT_THAT(at_rest("{body: low, point: 61 5 2 mm, outside: nearest}")[0], is(0.061));
}

struct Broken {
  const char* probe;
  ErrorKind kind;
  const char* message;
};

TEST(Probes, WhatTheMeshRefusesNamesItsPlace) {
  for (const Broken& broken :
       {Broken{"{body: low, point: 90 5 2 mm}", ErrorKind::point_outside_mesh,
               "point 0 of probe 'p'"},
        Broken{"{body: low, extent: {set: x_mx, along: x}}", ErrorKind::unknown_set, "x_mx"},
        Broken{"{body: low, extent: {box: 7 0 0 8 1 1 m, along: x}}", ErrorKind::empty_region,
               "no node"},
        Broken{"{body: low, bend: [{set: x_min}, {box: 0 0 0 60 0 0 mm}]}",
               ErrorKind::degenerate_orientation, "on one line"},
        Broken{"{body: low, bend: [{set: x_min}, {set: x_max}], about: x}",
               ErrorKind::degenerate_orientation, "along the axis"}}) {
    try {
      simulation_with(broken.probe);
      ADD_FAILURE() << "accepted: " << broken.probe;
    } catch (const Error& error) {
      EXPECT_EQ(error_kind_name(error.kind()), error_kind_name(broken.kind)) << error.what();
      EXPECT_THAT(std::string(error.what()), testing::HasSubstr(broken.message));
      EXPECT_EQ(error.place().line, 16) << error.what();
    }
  }
}

}  // namespace
}  // namespace sinew::scene
