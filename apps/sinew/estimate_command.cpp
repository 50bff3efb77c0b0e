// sinew estimate: forces, shape and numbers of a robot from recorded readings, from Python.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "python_tool.hpp"

namespace sinew::cli {

namespace {

struct EstimateOptions {
  std::string scene, measured;
  std::vector<std::string> stds, forces, parameters, markers, overrides;
  std::optional<std::string> out, walk, method, search;
  bool quiet = false;
};

int estimate(const EstimateOptions& options) {
  PythonWords words;
  words.add("measured", options.measured);
  words.add("std", options.stds);
  words.add("force", options.forces);
  words.add("parameter", options.parameters);
  words.add("marker", options.markers);
  words.add("set", options.overrides);
  words.add("out", options.out);
  words.add("walk", options.walk);
  words.add("method", options.method);
  words.add("search", options.search);
  words.add_flag("quiet", options.quiet);
  return become_python_module("sinew.estimate", words.with({options.scene}));
}

void add_readings(Command& command, EstimateOptions& options) {
  command
      .add_option("--measured", options.measured,
                  "CSV of readings: columns 'time [s]', 'tip.x [mm]', 'long_0.tension [N]' as in "
                  "run.csv; empty cells are no readings")
      .type_name("FILE")
      .required();
  command
      .add_option("--std", options.stds,
                  "Standard deviation of a sensor, NAME a column or a pattern: tip.*=0.1mm; may be "
                  "repeated. Columns of actuators without one are exact commands, others unused")
      .type_name("NAME=STD")
      .allow_extra_args(false)
      .required();
  command
      .add_option("--marker", options.markers,
                  "A measured point that the scene does not declare: low=trunk:0 18 70 mm; may be "
                  "repeated")
      .type_name("NAME=BODY:POINT")
      .allow_extra_args(false);
}

void add_unknowns(Command& command, EstimateOptions& options) {
  command
      .add_option("--force", options.forces,
                  "A force of unknown size and direction at a known place, and the standard "
                  "deviation of its components before: hand=trunk:0 0 195 mm:1N; may be repeated")
      .type_name("NAME=BODY:POINT:STD")
      .allow_extra_args(false);
  command
      .add_option("--parameter", options.parameters,
                  "A number of the scene, where to start and its relative standard deviation: "
                  "bodies.trunk.material.young_modulus=450kPa:0.3; may be repeated")
      .type_name("PATH=START:STD")
      .allow_extra_args(false);
  command
      .add_option("--search", options.search,
                  "A push at an unknown place of a body: trunk:48:1N searches 48 patches")
      .type_name("BODY:PATCHES:STD");
  command
      .add_option("--walk", options.walk, "How fast forces wander, N per root second (default: 1)")
      .type_name("RATE");
}

}  // namespace

void add_estimate(CommandLine& line) {
  Command command = line.add_command(
      "estimate", "Estimate forces and numbers of a robot from readings: docs/estimation.md");
  const auto options = std::make_shared<EstimateOptions>();
  command.add_option("SCENE", options->scene, "Scene file (YAML)").required();
  add_readings(command, *options);
  add_unknowns(command, *options);
  command
      .add_option("--method", options->method,
                  "settled (every row by itself), extended, unscented or horizon (default: "
                  "extended; settled for parameters)")
      .type_name("METHOD");
  command.add_option("--set", options->overrides, "Set a value of the scene; may be repeated")
      .type_name("PATH=VALUE")
      .allow_extra_args(false);
  command.add_option("--out", options->out, "Output folder (default: out/<scene name>-estimate)")
      .type_name("DIR");
  command.add_flag("--quiet", options->quiet, "No summary");
  command.footer(
      "Example:\n"
      "  sinew estimate examples/trunk/trunk.yaml --measured out/trunk/run.csv --std "
      "tip.*=0.1mm\n"
      "      --force \"hand=trunk:0 0 195 mm:1N\"");
  command.set_action([options] { return estimate(*options); });
}

}  // namespace sinew::cli
