// sinew schema, reference and validate.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/scene/reference.hpp"
#include "sinew/scene/scene.hpp"

#include "commands.hpp"
#include "completion.hpp"
#include "program_folder.hpp"
#include "python_tool.hpp"

namespace sinew::cli {

namespace {

namespace fs = std::filesystem;

// The folder set by the environment, that of the source tree, or the installed one.
fs::path validation_script() {
  std::vector<fs::path> folders;
  if (const char* chosen = std::getenv("SINEW_VALIDATION_DIR")) {
    folders = {chosen};
  } else {
    folders = {SINEW_VALIDATION_DEFAULT, program_folder().parent_path() / "share/sinew/validation"};
  }
  for (const fs::path& folder : folders) {
    if (fs::exists(folder / "run.py")) return folder / "run.py";
  }
  throw Error(ErrorKind::tool_missing, {.file = (folders.front() / "run.py").string()},
              "the validation cases are missing",
              "run in a source tree, or set SINEW_VALIDATION_DIR to its folder validation");
}

struct ValidateOptions {
  std::vector<std::string> cases;
  bool list = false, fast = false, resume = false;
  std::optional<std::string> out;
  std::optional<int> jobs;
};

int validate(const ValidateOptions& options) {
  PythonWords words;
  words.add_flag("list", options.list);
  words.add_flag("fast", options.fast);
  words.add_flag("resume", options.resume);
  words.add("out", options.out);
  words.add("jobs", options.jobs);
  std::vector<std::string> all = words.with(options.cases);
  all.insert(all.begin(), validation_script().string());
  return become_python(std::move(all), "the validation is written in Python");
}

Command add_page(CommandLine& line, const char* name, const char* description,
                 std::string (*page)()) {
  Command command = line.add_command(name, description);
  command.set_action([page] {
    const std::string text = page();
    const bool written =
        std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    return written ? 0 : 1;
  });
  return command;
}

}  // namespace

void add_schema(CommandLine& line) {
  add_page(line, "schema", "Print the JSON Schema of scene files, for completion in editors",
           scene::json_schema)
      .footer(
          "Example:\n"
          "  sinew schema > scene.schema.json\n\n"
          "An editor with a YAML language server completes and checks scenes that begin with\n"
          "  # yaml-language-server: $schema=scene.schema.json");
  add_page(line, "reference", "", [] {
    std::string text;
    for (const scene::ReferencePage& page : scene::reference_pages()) text += page.text;
    return text;
  }).hide();
}

void add_completion(CommandLine& line) {
  Command command = line.add_command("completion", "Print a shell completion script");
  const auto shell = std::make_shared<std::string>();
  command.add_option("SHELL", *shell, "Shell: bash, zsh or fish").type_name("NAME").required();
  command.footer(
      "Examples:\n"
      "  sinew completion bash > ~/.local/share/bash-completion/completions/sinew\n"
      "  sinew completion zsh > ~/.zfunc/_sinew     # with fpath+=~/.zfunc before compinit\n"
      "  sinew completion fish > ~/.config/fish/completions/sinew.fish\n\n"
      "Completes commands, options and file names in new shells. For the current shell, run\n"
      "  source <(sinew completion bash)");
  command.set_action([&line, shell] {
    const auto shells = completed_shells();
    fmt::print("{}", completion_script(*shell, line.commands(),
                                       {{"--shape", scene::shape_names()},
                                        {"completion", {shells.begin(), shells.end()}}}));
    return 0;
  });
}

void add_validate(CommandLine& line) {
  Command command =
      line.add_command("validate", "Run the validation suite and write the scorecard");
  const auto options = std::make_shared<ValidateOptions>();
  command.add_option("CASE", options->cases, "Names of cases (default: all)");
  command.add_flag("--list", options->list, "List the cases and exit");
  command.add_flag("--fast", options->fast, "Run only the cases that take seconds");
  command.add_flag("--resume", options->resume,
                   "Continue an interrupted run: skip cases already finished with this build");
  command
      .add_option("--out", options->out,
                  "Output folder for scorecard.md and images/validation (default: docs)")
      .type_name("DIR");
  command.add_option("--jobs", options->jobs, "Cases to run in parallel (default: one per core)")
      .type_name("N");
  command.footer(
      "Examples:\n"
      "  sinew validate --list\n"
      "  sinew validate patch_test --out /tmp/validation");
  command.set_action([options] { return validate(*options); });
}

}  // namespace sinew::cli
