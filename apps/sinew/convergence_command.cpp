// sinew convergence: what the mesh of a scene costs in accuracy, from Python.
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
  Command command =
      line.add_command("convergence", "Refine a scene's meshes and estimate what they cost");
  const auto options = std::make_shared<ConvergenceOptions>();
  command.add_option("SCENE", options->scene, "Scene file (YAML)").required();
  command
      .add_option("--measure", options->measures,
                  "What to compare at the end: tip.position, trunk.strain_energy; may be repeated "
                  "(default: all effectors)")
      .type_name("NAME")
      .allow_extra_args(false);
  command.add_option("--levels", options->levels, "Meshes, the scene's own included (default: 3)")
      .type_name("N");
  command.add_option("--duration", options->duration, "How long to simulate (default: the scene's)")
      .type_name("TIME");
  command.add_flag("--static", options->fixed, "A static equilibrium in place of a run");
  command
      .add_option("--set", options->overrides,
                  "Set a value of the scene for all meshes; may be repeated")
      .type_name("PATH=VALUE")
      .allow_extra_args(false);
  command.add_option("--json", options->out, "File for the figures, in SI units").type_name("FILE");
  command.footer(
      "Shapes get smaller cells, tetrahedra of mesh files are cut in eight.\n\n"
      "Examples:\n"
      "  sinew convergence examples/trunk/trunk.yaml --duration 1s --levels 2\n"
      "  sinew convergence beam.yaml --static --measure tip.position");
  command.set_action([options] { return converge(*options); });
}

}  // namespace sinew::cli
