// The named numbers on which motion depends.
#include "sinew/sim/parameters.hpp"

#include <algorithm>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

#include "../toys/spring_point.hpp"
#include "robots.hpp"

namespace sinew::sim {
namespace {

using sinew::testing::beam;
using sinew::testing::BeamOptions;

const Parameter* find(const std::vector<Parameter>& all, const std::string& path) {
  const auto found = std::ranges::find(all, path, &Parameter::path);
  return found == all.end() ? nullptr : &*found;
}

TEST(Parameters, HaveUniquePaths) {
  const Simulation simulation(beam({}));
  std::vector<std::string> paths;
  for (const Parameter& one : parameters(simulation)) paths.push_back(one.path);
  std::ranges::sort(paths);
  EXPECT_EQ(std::ranges::adjacent_find(paths), paths.end());
  EXPECT_GT(paths.size(), 5U);
}

// Bodies that the library does not know list theirs by the same visit.
TEST(Parameters, OfABodyFromOutside) {
  builder::ModelBuilder builder;
  const sinew::testing::SpringPointSettings settings;
  builder.add_body<sinew::testing::SpringPointModel>(settings);
  const Simulation simulation(builder.build());
  const std::vector<Parameter> all = parameters(simulation);
  const Parameter* stiffness =
      find(all, "bodies." + simulation.model().body(0).name() + ".stiffness");
  ASSERT_NE(stiffness, nullptr);
  EXPECT_EQ(stiffness->value, settings.stiffness);
  EXPECT_EQ(stiffness->unit, "N/m");
}

TEST(Parameters, SetInputs) {
  Simulation simulation(beam({}));
  const std::string body = simulation.model().body(0).name();
  const std::string factor = "bodies." + body + ".stiffness_factor";
  set_parameter(simulation, factor, 1.5);
  EXPECT_EQ(find(parameters(simulation), factor)->value, 1.5);
  const model::ActuatorModel& cable = simulation.model().actuators().front();
  set_parameter(simulation, "actuators." + cable.name + ".command.tension", 0.7);
  EXPECT_EQ(simulation.actuator(0).command.signal.value(0.0), 0.7);
  EXPECT_EQ(simulation.actuator(0).command.kind, model::CommandKind::effort);
}

TEST(Parameters, RefuseWhatIsNoInput) {
  Simulation simulation(beam({}));
  const std::string body = simulation.model().body(0).name();
  const auto error_of = [&](const std::string& path, double value = 1.0) {
    try {
      set_parameter(simulation, path, value);
    } catch (const Error& error) {
      return std::pair(error.kind(), std::string(error.what()));
    }
    return std::pair(ErrorKind::internal, std::string());
  };
  const auto [model_kind, model_text] = error_of("bodies." + body + ".material.young_modulus");
  EXPECT_EQ(model_kind, ErrorKind::bad_argument);
  EXPECT_NE(model_text.find("change what the scene states"), std::string::npos);
  const auto [kind, text] = error_of("bodies." + body + ".stifness_factor");
  EXPECT_EQ(kind, ErrorKind::unknown_name);
  EXPECT_NE(text.find("did you mean 'bodies." + body + ".stiffness_factor'"), std::string::npos);
  EXPECT_EQ(error_of("bodies." + body + ".stiffness_factor", -1.0).first, ErrorKind::out_of_range);
  EXPECT_EQ(error_of("").first, ErrorKind::unknown_name);
}

}  // namespace
}  // namespace sinew::sim
