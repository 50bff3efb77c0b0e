/// @file
/// Running other programs.
#pragma once

#include <string>
#include <vector>

namespace sinew {

/// Exit code and output of a program.
struct ProcessResult {
  int exit_code = 0;   ///< 128 + signal if a signal ended it
  std::string output;  ///< standard output and error together
};

/// Whether a program exists, on the PATH unless it has a slash.
/// @param program name or path.
bool program_exists(const std::string& program);

/// Runs a program from the PATH without a shell, and waits until it ends. Throws
/// Error(tool-missing) if it cannot be started, and Error(tool-failed) if there is no pipe for its
/// output.
/// @param arguments the program and its arguments.
ProcessResult run_program(const std::vector<std::string>& arguments);

/// The last lines of a text, without blanks at its end.
/// @param text to cut.
/// @param count number of lines.
std::string last_lines(const std::string& text, int count);

}  // namespace sinew
