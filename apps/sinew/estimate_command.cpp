// sinew estimate: forces, shape and parameters of a robot from recorded samples, in Python.
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
                  "CSV of measurements with columns as in run.csv: 'time [s]', 'tip.x [mm]', "
                  "'long_0.tension [N]'; an empty cell is a missing reading")
      .type_name("FILE")
      .required();
  command
      .add_option("--std", options.stds,
                  "Standard deviation of the columns that match NAME, e.g. tip.*=0.1mm "
                  "(repeatable). Actuator columns without one are exact commands, all others are "
                  "ignored")
      .type_name("NAME=STD")
      .allow_extra_args(false)
      .required();
  command
      .add_option("--marker", options.markers,
                  "Measured point that is not in the scene, e.g. \"low=trunk:0 18 70 mm\" "
                  "(repeatable)")
      .type_name("NAME=BODY:POINT")
      .allow_extra_args(false);
}

void add_unknowns(Command& command, EstimateOptions& options) {
  command
      .add_option("--force", options.forces,
                  "Unknown force vector at a known point, with the prior standard deviation of its "
                  "components, e.g. \"hand=trunk:0 0 195 mm:1N\" (repeatable)")
      .type_name("NAME=BODY:POINT:STD")
      .allow_extra_args(false);
  command
      .add_option("--parameter", options.parameters,
                  "Unknown scene parameter, with its initial value and relative prior standard "
                  "deviation, e.g. bodies.trunk.material.young_modulus=450kPa:0.3 (repeatable)")
      .type_name("PATH=START:STD")
      .allow_extra_args(false);
  command
      .add_option("--search", options.search,
                  "Locate an unknown force on a body's surface, divided into PATCHES, e.g. "
                  "trunk:48:1N")
      .type_name("BODY:PATCHES:STD");
  command.add_option("--walk", options.walk, "Random walk of the forces, N/sqrt(s) (default: 1)")
      .type_name("RATE");
}

}  // namespace

void add_estimate(CommandLine& line) {
  Command command =
      line.add_command("estimate", "Estimate external forces and parameters from measurements");
  const auto options = std::make_shared<EstimateOptions>();
  command.add_option("SCENE", options->scene, "Scene file (YAML)").required();
  add_readings(command, *options);
  add_unknowns(command, *options);
  command
      .add_option("--method", options->method,
                  "Estimator: settled (each row separately, at rest), extended, unscented or "
                  "horizon (default: extended; settled with --parameter)")
      .type_name("METHOD");
  command.add_option("--set", options->overrides, "Override a scene value (repeatable)")
      .type_name("PATH=VALUE")
      .allow_extra_args(false);
  command.add_option("--out", options->out, "Output folder (default: out/<scene name>-estimate)")
      .type_name("DIR");
  command.add_flag("--quiet", options->quiet, "Suppress the summary");
  command.footer(
      "Writes estimate.csv to the output folder. Guide: docs/estimation.md.\n\n"
      "Example:\n"
      "  sinew estimate examples/trunk/trunk.yaml --measured out/trunk/run.csv --std "
      "tip.*=0.1mm\n"
      "      --force \"hand=trunk:0 0 195 mm:1N\"");
  command.set_action([options] { return estimate(*options); });
}

}  // namespace sinew::cli
