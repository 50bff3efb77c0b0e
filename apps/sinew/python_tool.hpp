/// @file
/// Runs the parts of the program that are written in Python, such as validation and plots.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace sinew::cli {

/// Debian's interpreter, which finds Debian's packages.
inline constexpr const char* kInterpreter = "/usr/bin/python3";

/// Adds the Python package of the same build as this program to PYTHONPATH.
void use_own_python_package();

/// Runs the package's plot.py, waits, and returns its exit code. Throws Error(tool-missing) if the
/// script or the interpreter is missing. @param arguments of plot.py.
int draw_plot(const std::vector<std::string>& arguments);

/// Collects the arguments with which a command calls its Python part: "--name=value".
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
  /// Adds "--name" if it is set.
  void add_flag(const char* option, bool set) {
    if (set) words_.push_back(fmt::format("--{}", option));
  }
  /// All words, then "--" and the operands, which may start with a dash.
  std::vector<std::string> with(const std::vector<std::string>& operands) const {
    std::vector<std::string> all = words_;
    all.emplace_back("--");
    all.insert(all.end(), operands.begin(), operands.end());
    return all;
  }

 private:
  std::vector<std::string> words_;
};

/// Replaces this program by the interpreter, in which `import sinew` finds the package of the same
/// build. Throws Error(tool-missing) if there is no interpreter.
/// @param words arguments of the interpreter: a script, or "-m" and a module, and their arguments.
/// @param what purpose, for the error.
int become_python(std::vector<std::string> words, const std::string& what);

/// Replaces this program by a module of the package, which then owns signals, terminal and exit
/// code. Throws Error(tool-missing) if there is no interpreter.
/// @param module such as "sinew.sweep". @param arguments of the module.
int become_python_module(const std::string& module, const std::vector<std::string>& arguments);

/// Runs a module of the package, waits, and returns its exit code. Throws what
/// become_python_module() throws. @param module,arguments as for become_python_module().
int run_python_module(const std::string& module, const std::vector<std::string>& arguments);

/// Plots the results of a command, and returns the exit code of draw_plot(). Throws what
/// draw_plot() and write_file() throw.
/// @param kind of plot, such as "fit". @param json the results. @param out PNG file.
int draw_json(const std::string& kind, const std::string& json, const std::string& out);

}  // namespace sinew::cli
