/// @file
/// Parses arguments of options as quantities.
#pragma once

#include <string>

#include "sinew/core/error.hpp"
#include "sinew/core/quantity.hpp"

namespace sinew::cli {

/// Parses a quantity greater than zero (SI). Throws Error at the option: what parse_quantity()
/// throws, and out-of-range.
/// @param option name, for messages. @param text such as "5s". @param dimension expected.
double positive_quantity(const std::string& option, const std::string& text, Dimension dimension);

/// Parses a unit of length: "mm" is 0.001 m. Throws Error at the option.
/// @param option name, for messages. @param text the unit.
double length_unit(const std::string& option, const std::string& text);

/// Throws Error(out-of-range) at the option if a value is outside a range.
/// @param option name, for messages. @param value given. @param low,high inclusive limits.
void require_range(const std::string& option, long value, long low, long high);

}  // namespace sinew::cli
