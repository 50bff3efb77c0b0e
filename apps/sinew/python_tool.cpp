#include "python_tool.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"

#include "program_folder.hpp"

namespace sinew::cli {

void use_own_python_package() {
  const std::filesystem::path package = program_folder().parent_path() / "python";
  if (!std::filesystem::exists(package)) return;
  const char* before = std::getenv("PYTHONPATH");
  const std::string path = package.string() + (before == nullptr ? "" : ":" + std::string(before));
  setenv("PYTHONPATH", path.c_str(), 1);
}

namespace {

// The plotting script: in the build of this program, in its source tree, or installed.
std::filesystem::path plot_script() {
  const std::filesystem::path around = program_folder().parent_path();
  for (const std::filesystem::path& path :
       {around / "python/sinew/plot.py", std::filesystem::path(SINEW_PLOT_DEFAULT),
        around / "lib/python3/dist-packages/sinew/plot.py"}) {
    if (std::filesystem::exists(path)) return path;
  }
  throw Error(ErrorKind::tool_missing, {.file = SINEW_PLOT_DEFAULT},
              "the plotting script is missing", "install the Python package");
}

// The arguments of execv().
std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> module_call(const std::string& module,
                                     const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {"-m", module};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

[[noreturn]] void throw_missing_interpreter(const std::string& what) {
  throw Error(ErrorKind::tool_missing, {.file = kInterpreter},
              fmt::format("{}, but Python cannot be started", what),
              "apt-get install python3 python3-numpy python3-matplotlib");
}

int run_interpreter(std::vector<std::string> words) {
  words.insert(words.begin(), kInterpreter);
  std::vector<char*> pointers = pointers_to(words);
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    execv(kInterpreter, pointers.data());
    _exit(127);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) < 0 || !WIFEXITED(status) ||
      WEXITSTATUS(status) == 127) {
    throw_missing_interpreter("this command needs the Python package");
  }
  return WEXITSTATUS(status);
}

}  // namespace

int draw_plot(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {plot_script().string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_interpreter(std::move(words));
}

int run_python_module(const std::string& module, const std::vector<std::string>& arguments) {
  use_own_python_package();
  return run_interpreter(module_call(module, arguments));
}

int become_python(std::vector<std::string> words, const std::string& what) {
  use_own_python_package();
  words.insert(words.begin(), kInterpreter);
  std::vector<char*> pointers = pointers_to(words);
  std::fflush(stdout);
  execv(kInterpreter, pointers.data());
  throw_missing_interpreter(what);
}

int become_python_module(const std::string& module, const std::vector<std::string>& arguments) {
  return become_python(module_call(module, arguments),
                       fmt::format("'{}' is part of the Python package", module));
}

int draw_json(const std::string& kind, const std::string& json, const std::string& out) {
  const std::string data = out + ".json";
  write_file(data, json);
  std::fflush(stdout);
  const int code = draw_plot({kind, data, out});
  std::error_code ignored;
  std::filesystem::remove(data, ignored);
  return code;
}

}  // namespace sinew::cli
