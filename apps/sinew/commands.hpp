/// @file
/// The commands of the program, one a file. Each adds itself to the command line and runs when it
/// was chosen; what goes wrong is thrown as Error.
#pragma once

#include <functional>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace sinew::cli {

/// What a chosen command does; returns the exit code.
using Action = std::function<int()>;
/// Actions by command.
using Actions = std::map<const CLI::App*, Action>;

/// @name Commands
/// @param app to add to. @param actions takes what the command does.
/// @{
void add_run(CLI::App& app, Actions& actions);
void add_bench(CLI::App& app, Actions& actions);
void add_validate(CLI::App& app, Actions& actions);
void add_info(CLI::App& app, Actions& actions);
void add_mesh(CLI::App& app, Actions& actions);
void add_view(CLI::App& app, Actions& actions);
void add_schema(CLI::App& app, Actions& actions);
void add_fit(CLI::App& app, Actions& actions);
void add_reach(CLI::App& app, Actions& actions);
void add_plan(CLI::App& app, Actions& actions);
void add_brace(CLI::App& app, Actions& actions);
void add_identify(CLI::App& app, Actions& actions);
void add_plot(CLI::App& app, Actions& actions);
/// @}

}  // namespace sinew::cli
