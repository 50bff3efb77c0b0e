/// @file
/// The commands of the program, each in a file of its own. Each function adds its command to the
/// command line. Actions of commands throw Error.
#pragma once

#include "command_line.hpp"

namespace sinew::cli {

/// @name Commands
/// @param line to which the command is added.
/// @{
void add_run(CommandLine& line);
void add_bench(CommandLine& line);
void add_validate(CommandLine& line);
void add_info(CommandLine& line);
void add_mesh(CommandLine& line);
void add_view(CommandLine& line);
void add_schema(CommandLine& line);
void add_fit(CommandLine& line);
void add_materials(CommandLine& line);
void add_reach(CommandLine& line);
void add_plan(CommandLine& line);
void add_brace(CommandLine& line);
void add_identify(CommandLine& line);
void add_plot(CommandLine& line);
void add_sweep(CommandLine& line);
void add_estimate(CommandLine& line);
void add_completion(CommandLine& line);
void add_convergence(CommandLine& line);
/// @}

}  // namespace sinew::cli
