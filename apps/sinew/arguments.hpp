/// @file
/// Arguments as quantities.
#pragma once

#include <string>

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

}  // namespace sinew::cli
