/// @file
/// Units in the column names of a table.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sinew/core/quantity.hpp"

namespace sinew::identify {

/// The name in lower case, with blanks in place of _ and -.
std::string plain_name(std::string_view name);

/// Factor to SI units of a column called "stress [MPa]", "stress (MPa)" or "stress_MPa"; none if
/// its name has no such unit. @param name of the column. @param dimension of the unit.
std::optional<double> column_unit(const std::string& name, Dimension dimension);

}  // namespace sinew::identify
