// sinew schema, reference and validate: each a few lines.
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "sinew/core/error.hpp"
#include "sinew/scene/reference.hpp"

#include "commands.hpp"
#include "program_folder.hpp"
#include "python_tool.hpp"

namespace sinew::cli {

namespace {

namespace fs = std::filesystem;

// The environment's choice, the tree that this program was built from, or the installed one.
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
              "the validation cases are not there",
              "run from a source tree, or set SINEW_VALIDATION_DIR to its folder 'validation'");
}

int validate(const std::vector<std::string>& cases) {
  const std::string script = validation_script().string();
  use_own_python_package();
  std::vector<char*> arguments;
  std::vector<std::string> words = {kInterpreter, script};
  words.insert(words.end(), cases.begin(), cases.end());
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::fflush(stdout);
  execv(kInterpreter, arguments.data());
  throw Error(ErrorKind::tool_missing, {.file = kInterpreter},
              fmt::format("the interpreter cannot be started: {}", std::strerror(errno)),
              "install Python: apt-get install python3 python3-numpy python3-matplotlib");
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
  add_page(line, "schema", "Print the JSON Schema of scene files, for editors", scene::json_schema);
  add_page(line, "reference", "", scene::reference_page).hide();
}

void add_validate(CommandLine& line) {
  Command command =
      line.add_command("validate", "Compare Sinew's numbers with references: docs/scorecard.md");
  const auto cases = std::make_shared<std::vector<std::string>>();
  command.add_option("CASE", *cases, "Cases to run (default: all)");
  command.allow_extras();  // options of the script itself: --list
  command.footer("Example:\n  sinew validate --list");
  command.set_action([cases, command] {
    std::vector<std::string> all = *cases;
    for (const std::string& word : command.remaining()) all.push_back(word);
    return validate(all);
  });
}

}  // namespace sinew::cli
