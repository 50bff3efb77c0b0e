// sinew convergence: the discretisation error of a scene's mesh, in Python.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "python_tool.hpp"

namespace sinew::cli {

namespace {

struct ConvergenceOptions {
  std::string scene;
  std::vector<std::string> measures, overrides;
  std::optional<std::string> duration, out;
  std::optional<int> levels;
  bool fixed = false;
};

int converge(const ConvergenceOptions& options) {
  PythonWords words;
  words.add("measure", options.measures);
  words.add("set", options.overrides);
  words.add("levels", options.levels);
  words.add("duration", options.duration);
  words.add("json", options.out);
  words.add_flag("static", options.fixed);
  return become_python_module("sinew.convergence", words.with({options.scene}));
}

}  // namespace

void add_convergence(CommandLine& line) {
  Command command = line.add_command(
      "convergence", "Refine the meshes of a scene and estimate their discretisation error");
  const auto options = std::make_shared<ConvergenceOptions>();
  command.add_option("SCENE", options->scene, "Scene file (YAML)").required();
  command
      .add_option("--measure", options->measures,
                  "Quantity to compare at the end, e.g. tip.position or trunk.strain_energy "
                  "(repeatable; default: all effectors)")
      .type_name("NAME")
      .allow_extra_args(false);
  command
      .add_option("--levels", options->levels,
                  "Number of meshes, including the scene's own (default: 3)")
      .type_name("N");
  command
      .add_option("--duration", options->duration, "Simulated time, e.g. 5s (default: the scene's)")
      .type_name("TIME");
  command.add_flag("--static", options->fixed,
                   "Solve for static equilibrium instead of simulating");
  command
      .add_option("--set", options->overrides, "Override a scene value on all meshes (repeatable)")
      .type_name("PATH=VALUE")
      .allow_extra_args(false);
  command.add_option("--json", options->out, "Also write the results as JSON, in SI units")
      .type_name("FILE");
  command.footer(
      "Primitive shapes are meshed with smaller elements; tetrahedra of mesh files are split into\n"
      "eight. Guide: docs/convergence.md.\n\n"
      "Examples:\n"
      "  sinew convergence examples/trunk/trunk.yaml --duration 1s --levels 2\n"
      "  sinew convergence beam.yaml --static --measure tip.position");
  command.set_action([options] { return converge(*options); });
}

}  // namespace sinew::cli
