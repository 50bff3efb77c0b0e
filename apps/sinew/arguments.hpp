/// @file
/// Arguments as quantities, and what is said when the command line is wrong.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "sinew/core/error.hpp"
#include "sinew/core/quantity.hpp"

namespace sinew::cli {

/// A quantity greater than zero. Throws Error at the option: what parse_quantity() throws, and
/// out-of-range.
/// @param option its name, for messages. @param text "5s". @param dimension expected.
double positive_quantity(const std::string& option, const std::string& text, Dimension dimension);

/// Meters in one unit of a file: "mm". Throws Error at the option.
/// @param option its name, for messages. @param text the unit.
double length_unit(const std::string& option, const std::string& text);

/// Throws Error(out-of-range) at the option when it is outside.
/// @param option its name. @param value given. @param low,high inclusive limits.
void require_range(const std::string& option, long value, long low, long high);

/// What CLI11 found wrong, as an error of ours: unknown commands and options with the nearest known
/// one, missing and superfluous arguments.
/// @param app as it was parsed. @param problem thrown by it.
Error argument_error(const CLI::App& app, const CLI::ParseError& problem);

/// Throws Error(unknown-option) when the first argument is no option and no command.
/// @param app with its commands. @param argc,argv of main().
void require_command(const CLI::App& app, int argc, const char* const* argv);

}  // namespace sinew::cli
