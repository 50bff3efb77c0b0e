#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/scene/scene.hpp"

#include "scene_fixture.hpp"

namespace sinew::scene {
namespace {

SceneDescription with(const std::vector<std::string>& assignments, const Edits& edits = {}) {
  Node tree = parse_yaml(edited(edits), "scene.yaml");
  for (const std::string& assignment : assignments) apply_override(tree, assignment);
  return parse_scene_tree(tree, {}, Files::ignore);
}

TEST(Override, SetsAValue) {
  const SceneDescription scene =
      with({"actuators.long_0.command.displacement=10mm", "time_step=5 ms",
            "bodies.trunk.material.young_modulus=1MPa", "record.states=false"});
  EXPECT_DOUBLE_EQ(scene.actuators[0].command.signal.value(0), 0.01);
  EXPECT_DOUBLE_EQ(scene.time_step, 0.005);
  EXPECT_DOUBLE_EQ(scene.bodies[0].material.young_modulus, 1e6);
  EXPECT_FALSE(scene.record.states);
}

TEST(Override, MakesTheMapsItNeeds) {
  const SceneDescription scene = with({"solver.threads=4", "duration=2s"});
  EXPECT_EQ(scene.solver.threads, 4);
  EXPECT_EQ(scene.run_duration(), 2.0);
}

TEST(Override, TakesAnyYaml) {
  const SceneDescription scene =
      with({"actuators.long_0.command.displacement={ramp: {to: 10 mm, duration: 2 s}}",
            "effectors.tip.point=[0, 0, 0.1]"});
  EXPECT_DOUBLE_EQ(scene.actuators[0].command.signal.end_time(), 2.0);
  EXPECT_EQ(scene.effectors[0].points.points(0, 2), 0.1);
}

TEST(Override, ReplacesAlternatives) {
  const SceneDescription scene =
      with({"actuators.long_0.command.tension=2N", "bodies.trunk.density=1000"});
  EXPECT_EQ(scene.actuators[0].command.kind, model::CommandKind::effort);
  EXPECT_FALSE(scene.bodies[0].mass.has_value());
  EXPECT_EQ(scene.bodies[0].density.value(), 1000.0);
}

TEST(Override, RemovesWhatBelongedToTheAlternative) {
  const Edits file = {{"{displacement: 0 mm}", "{displacement: {file: a.csv, unit: mm}}"}};
  const SceneDescription scene =
      with({"actuators.long_0.command.displacement.sine={amplitude: 1 mm, period: 1 s}"}, file);
  EXPECT_DOUBLE_EQ(scene.actuators[0].command.signal.value(0.25), 0.001);
  EXPECT_EQ(with({"bodies.trunk.density=1000"},
                 {{"mass: 42 g", "mass: 42 g\n    mass_distribution: even"}})
                .bodies[0]
                .mass_distribution,
            MassDistribution::volume);
}

TEST(Override, GoesIntoListsByNumber) {
  const Edits list = {{"{box: -20 -20 0 20 20 20 mm}", "[{set: a}, {box: -20 -20 0 20 20 20 mm}]"}};
  const SceneDescription scene = with({"bodies.trunk.fixed.1.set=b"}, list);
  EXPECT_EQ(scene.bodies[0].fixed[0].set, "a");
  EXPECT_EQ(scene.bodies[0].fixed[1].set, "b");
}

TEST(Override, AWordThatIsShortForAMapIsKept) {
  const SceneDescription scene =
      with({"solver.threads=3"}, {{"record:", "solver: newton\nrecord:"}});
  EXPECT_EQ(scene.solver.method, Method::newton);
  EXPECT_EQ(scene.solver.threads, 3);
  EXPECT_EQ(with({"integrator.type=backward-euler"}).integrator, Integrator::backward_euler);
}

TEST(Override, WrongValuesAreReportedByThePath) {
  try {
    with({"bodies.trunk.mass=42 mm"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::wrong_dimension);
    EXPECT_EQ(error.place().text(), "--set: bodies.trunk.mass");
  }
  try {
    with({"bodies.trunk.fixed=[{set: a}, {sett: b}]"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.place().text(), "--set: bodies.trunk.fixed[1].sett");
  }
  try {
    with({"bodies.trunk.mass={a: 1, a: 2}"});  // the location in the value is useful
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.place().text(), "--set bodies.trunk.mass:1:8");
  }
}

struct BadOverride {
  const char* name;
  const char* assignment;
  ErrorKind kind;
  const char* message;
  const char* remedy;
};

void PrintTo(const BadOverride& bad, std::ostream* out) { *out << bad.name; }

class BadOverrides : public testing::TestWithParam<BadOverride> {};

TEST_P(BadOverrides, AreRefusedAndChangeNothing) {
  const Node before = parse_yaml(kExample, "scene.yaml");
  Node tree = before;
  try {
    apply_override(tree, GetParam().assignment);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error_kind_name(error.kind()), error_kind_name(GetParam().kind)) << error.what();
    EXPECT_THAT(error.what(), testing::HasSubstr("--set"));
    EXPECT_THAT(error.message(), testing::HasSubstr(GetParam().message));
    EXPECT_THAT(error.remedy(), testing::HasSubstr(GetParam().remedy));
  }
  EXPECT_TRUE(tree == before);
}

using K = ErrorKind;
INSTANTIATE_TEST_SUITE_P(
    Override, BadOverrides,
    testing::Values(BadOverride{"no_equals", "time_step", K::bad_argument, "'time_step'",
                                "time_step=5ms"},
                    BadOverride{"no_path", "=3", K::bad_argument, "'=3'", "path"},
                    BadOverride{"top_key", "timestep=5 ms", K::unknown_key, "'timestep'",
                                "did you mean 'time_step'?"},
                    BadOverride{"name", "actuators.long0.command.tension=1", K::unknown_name,
                                "'long0'", "did you mean 'long_0'?"},
                    BadOverride{"new_name", "actuators.short_7.command.tension=1", K::unknown_name,
                                "'short_7'", "long_0"},
                    BadOverride{"deep_key", "bodies.trunk.material.yung_modulus=1", K::unknown_key,
                                "'yung_modulus'", "young_modulus"},
                    BadOverride{"variant_key", "actuators.long_0.direction=0 0 1", K::unknown_key,
                                "'direction'", "points"},
                    BadOverride{"below_scalar", "time_step.unit=ms", K::unknown_key,
                                "nothing under time_step", "time (s)"},
                    BadOverride{"empty_step", "bodies..mass=1", K::unknown_name, "''", "trunk"},
                    BadOverride{"index", "effectors.tip.point.0=1", K::unknown_key, "nothing under",
                                "3 numbers"},
                    BadOverride{"yaml", "bodies.trunk.fixed={box: [1", K::syntax_error,
                                "in place of a key", "brackets"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sinew::scene
