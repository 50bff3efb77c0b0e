/// @file
/// Runs other programs.
#pragma once

#include <string>
#include <vector>

namespace sinew {

/// How a program ended and what it said.
struct ProcessResult {
  int exit_code = 0;   ///< 128 + signal when a signal ended it
  std::string output;  ///< standard output and error together
};

/// True when a program of this name is on the PATH.
/// @param program name or path.
bool program_exists(const std::string& program);

/// Runs a program, found on the PATH, without a shell, and waits for its end. Throws
/// Error(tool-missing) when it cannot be started.
/// @param arguments the program and its arguments.
ProcessResult run_program(const std::vector<std::string>& arguments);

/// The last lines of a text.
/// @param text to cut.
/// @param count of lines.
std::string last_lines(const std::string& text, int count);

}  // namespace sinew
