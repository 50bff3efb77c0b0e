/// @file
/// Parts of the program that are Python: validation and plots.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace sinew::cli {

/// Debian's interpreter, the one that sees Debian's packages.
inline constexpr const char* kInterpreter = "/usr/bin/python3";

/// Puts the Python package of the same build as this program on the interpreter's path.
void use_own_python_package();

/// Runs the package's plot.py and waits; its exit code.
/// @param arguments what to draw. Throws Error(tool-missing) when the script or the interpreter is
///   not there.
int draw_plot(const std::vector<std::string>& arguments);

/// The words with which a command calls its Python part, option by option: "--name=value".
class PythonWords {
 public:
  void add(const char* option, const std::string& value) {
    words_.push_back(fmt::format("--{}={}", option, value));
  }
  void add(const char* option, const std::vector<std::string>& values) {
    for (const std::string& value : values) add(option, value);
  }
  template <typename T>
  void add(const char* option, const std::optional<T>& value) {
    if (value) add(option, fmt::format("{}", *value));
  }
  /// "--name" where it is set.
  void add_flag(const char* option, bool set) {
    if (set) words_.push_back(fmt::format("--{}", option));
  }
  /// All words, and after them the operands, which may begin with a dash.
  std::vector<std::string> with(const std::vector<std::string>& operands) const {
    std::vector<std::string> all = words_;
    all.emplace_back("--");
    all.insert(all.end(), operands.begin(), operands.end());
    return all;
  }

 private:
  std::vector<std::string> words_;
};

/// Runs the interpreter in place of this program, where `import sinew` finds the package of its
/// build.
/// @param words of the interpreter: a script, or "-m" and a module, and their arguments. @param
/// what
///   says what for, where there is no interpreter. Throws Error(tool-missing) then.
int become_python(std::vector<std::string> words, const std::string& what);

/// Runs a module of the package in place of this program: signals and the terminal are its own, and
/// its exit code is the program's.
/// @param module "sinew.sweep". @param arguments of it. Throws Error(tool-missing) when the
///   interpreter is not there.
int become_python_module(const std::string& module, const std::vector<std::string>& arguments);

/// Runs a module of the package and waits; its exit code.
/// @param module,arguments,throws as become_python_module().
int run_python_module(const std::string& module, const std::vector<std::string>& arguments);

/// Draws figures of a command; the exit code of draw_plot().
/// @param kind what plot.py is to draw: "fit". @param json the figures. @param out PNG file.
/// Throws what draw_plot() and write_file() do.
int draw_json(const std::string& kind, const std::string& json, const std::string& out);

}  // namespace sinew::cli
