/// @file
/// Scripts with which shells complete commands, options, choices and file names.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "command_line.hpp"

namespace sinew::cli {

/// The supported shells: "bash", "zsh", "fish".
std::span<const char* const> completed_shells();

/// The completion script of a shell. Throws Error(unknown-choice) for an unsupported shell.
/// @param shell one of completed_shells(). @param commands of the program.
/// @param choices words of options and command arguments that take one of several words:
/// {"--shape", {"block", "cone"}}, {"completion", {"bash"}}.
std::string completion_script(const std::string& shell, const std::vector<CommandWords>& commands,
                              const std::map<std::string, std::vector<std::string>>& choices);

}  // namespace sinew::cli
