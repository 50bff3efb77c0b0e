// The sinew program. Exit codes: 0 done, 1 the run failed, 2 wrong input.
#include <exception>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "sinew/core/build_info.hpp"
#include "sinew/core/error.hpp"
#include "sinew/scene/reference.hpp"

#include "commands.hpp"

namespace sinew::cli {
namespace {

struct Options {
  RunOptions run;
  BenchOptions bench;
  InfoOptions info;
  MeshOptions mesh;
  std::vector<std::string> cases;
  std::string scene;
};

void add_run(CLI::App& app, RunOptions& options) {
  auto* command = app.add_subcommand("run", "Run a scene and record what happens");
  command->add_option("scene", options.scene, "Scene file (YAML)")->required();
  command->add_option("--duration", options.duration,
                      "How long, such as 5s (default: the scene's)");
  command
      ->add_option("--set", options.overrides,
                   "Override a value: actuators.long_0.command.displacement=10mm")
      ->allow_extra_args(false);
  command->add_option("--out", options.out, "Folder for the results (default: out/<scene name>)");
  command->add_option("--controller", options.controller,
                      "Which of the scene's controllers steers, or none (default: the first)");
  command->add_option("--threads", options.threads, "Threads inside a step")
      ->check(CLI::Range(1, 256));
  command->add_flag("--vtk", options.vtk, "Also write a .pvd series for ParaView");
  command->add_flag("--quiet", options.quiet, "No progress bar and no summary");
}

void add_bench(CLI::App& app, BenchOptions& options) {
  auto* command = app.add_subcommand("bench", "Time the stages of a scene's steps");
  command->add_option("scene", options.scene, "Scene file (YAML)")->required();
  command->add_option("--steps", options.steps, "Steps that count")->check(CLI::Range(1, 1000000));
  command->add_option("--warm-up", options.warm_up, "Steps before them")
      ->check(CLI::Range(0, 1000000));
  command->add_option("--threads", options.threads, "Threads inside a step")
      ->check(CLI::Range(1, 256));
  command->add_option("--json", options.json, "Also write the figures to this file");
  command->add_option("--tangent", options.tangent, "rotated or exact (default: the scene's)");
  command->add_option("--set", options.overrides, "Override a value of the scene")
      ->allow_extra_args(false);
  command->add_flag("--compare-eigen", options.compare_eigen,
                    "Also time Eigen's SimplicialLDLT on the same matrix");
}

void add_files(CLI::App& app, Options& options) {
  auto* info = app.add_subcommand("info", "Describe a mesh, surface, scene or recorded run");
  info->add_option("file", options.info.file, "The file")->required();
  info->add_option("--unit", options.info.unit, "Unit of a mesh's lengths, such as mm");
  auto* mesh = app.add_subcommand("mesh", "Fill a surface with tetrahedra, or make a shape");
  mesh->add_option("surface", options.mesh.input, "STL, OBJ or PLY file");
  mesh->add_option("--shape", options.mesh.shape,
                   "block, cylinder, cone, hollow-cylinder or trunk, instead of a surface");
  mesh->add_option("-o,--output", options.mesh.output, "VTU file to write")->required();
  mesh->add_option("--size", options.mesh.size, "Wanted edge length (default 5 mm)");
  mesh->add_option("--unit", options.mesh.unit, "Unit of the surface file, such as mm");
  mesh->add_option("--refine", options.mesh.refine, "Split every tetrahedron in 8, so many times")
      ->check(CLI::Range(0, 4));
}

[[noreturn]] void refuse_view() {
  throw Error(ErrorKind::not_in_this_version, {.file = {}, .item = "view"},
              "the browser view is not in this version",
              "run the scene with --vtk and look at the series in ParaView");
}

// CLI11's complaint with the nearest word that there is.
Error argument_error(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const CLI::App* at = &app;
  for (const CLI::App* command : app.get_subcommands()) at = command;
  std::vector<std::string> known;
  for (const CLI::App* command : at->get_subcommands([](const CLI::App*) { return true; })) {
    known.push_back(command->get_name());
  }
  for (const CLI::Option* option : at->get_options()) {
    for (const auto& name : option->get_lnames()) known.push_back("--" + name);
  }
  const bool unknown =
      dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr || (at == &app && argc > 1);
  std::string culprit, near;
  for (int i = 1; i < argc && near.empty() && unknown; ++i) {
    const std::string word(argv[i], std::string(argv[i]).find_first_of('=') == std::string::npos
                                        ? std::string(argv[i]).size()
                                        : std::string(argv[i]).find_first_of('='));
    if (std::find(known.begin(), known.end(), word) != known.end()) continue;
    if (at != &app && word.rfind("--", 0) != 0) continue;
    culprit = word;
    near = nearest_word(word, known);
  }
  return {unknown ? ErrorKind::unknown_option : ErrorKind::bad_argument,
          {.file = {}, .item = culprit.empty() ? "command line" : culprit},
          error.what(),
          near.empty() ? "see sinew --help" : fmt::format("did you mean '{}'?", near)};
}

int dispatch(const CLI::App& app, const Options& options) {
  const std::string command = app.get_subcommands().front()->get_name();
  if (command == "run") return run(options.run);
  if (command == "bench") return bench(options.bench);
  if (command == "info") return info(options.info);
  if (command == "mesh") return mesh(options.mesh);
  if (command == "validate") return validate(options.cases);
  if (command == "schema") fmt::print("{}", scene::json_schema());
  if (command == "reference") fmt::print("{}", scene::reference_page());
  if (command == "view") refuse_view();
  return 0;
}

int main(int argc, char** argv) {
  CLI::App app("Simulates and steers soft robots in real time", "sinew");
  app.set_version_flag("--version",
                       fmt::format("sinew {} ({}, {})", version(), compiler(), instruction_set()));
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  sinew run examples/trunk/circle.yaml --duration 5s --vtk\n"
      "  sinew bench examples/trunk/circle.yaml --steps 400 --threads 1\n"
      "  sinew info part.vtu --unit mm\n"
      "  sinew mesh part.stl --unit mm -o part.vtu --size 5mm\n"
      "Exit codes: 0 done, 1 the run failed, 2 wrong input.");
  Options options;
  add_run(app, options.run);
  add_bench(app, options.bench);
  add_files(app, options);
  app.add_subcommand("validate", "Run the validation suite and write docs/scorecard.md")
      ->prefix_command()
      ->add_option("cases", options.cases, "Names of cases (default: all)");
  app.add_subcommand("schema", "Print the JSON Schema of scene files, for editors");
  app.add_subcommand("reference", "Print the reference of scene files (Markdown)");
  auto* view = app.add_subcommand("view", "")->group("");
  view->add_option("scene", options.scene, "Scene file");
  view->allow_extras();
  try {
    try {
      app.parse(argc, argv);
    } catch (const CLI::CallForHelp& help) {
      return app.exit(help);
    } catch (const CLI::CallForVersion& call) {
      return app.exit(call);
    } catch (const CLI::ParseError& error) {
      throw argument_error(app, error, argc, argv);
    }
    return dispatch(app, options);
  } catch (const Error& error) {
    fmt::print(stderr, "sinew: error: {}\n", error.what());
    return error.is_run_failure() ? 1 : 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "sinew: error: {} [internal]\n", error.what());
    return 1;
  }
}

}  // namespace
}  // namespace sinew::cli

int main(int argc, char** argv) { return sinew::cli::main(argc, argv); }
