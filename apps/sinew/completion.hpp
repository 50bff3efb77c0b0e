/// @file
/// Scripts by which shells complete commands, options, choices and file names.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "command_line.hpp"

namespace sinew::cli {

/// "bash", "zsh", "fish".
std::span<const char* const> completed_shells();

/// @param shell one of completed_shells(). Throws Error(unknown-choice) for another one.
/// @param commands of the program.
/// @param choices of options, and of commands' arguments, that take one of several words:
///   {"--shape", {"block", "cone"}}, {"completion", {"bash"}}.
std::string completion_script(const std::string& shell, const std::vector<CommandWords>& commands,
                              const std::map<std::string, std::vector<std::string>>& choices);

}  // namespace sinew::cli
