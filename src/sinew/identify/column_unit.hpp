/// @file
/// Units in the names of a table's columns.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sinew/core/quantity.hpp"

namespace sinew::identify {

/// Small letters, with blanks for _ and -.
std::string plain_name(std::string_view name);

/// SI units of a column called "stress [MPa]", "stress (MPa)" or "stress_MPa"; none when what
/// stands there is no such unit. @param name of the column. @param dimension that the unit must
/// have.
std::optional<double> column_unit(const std::string& name, Dimension dimension);

}  // namespace sinew::identify
