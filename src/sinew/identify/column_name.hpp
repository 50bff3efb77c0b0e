/// @file
/// Names of columns in tables of measurements.
#pragma once

#include <string>
#include <string_view>

namespace sinew::identify {

/// The name in lower case, with blanks in place of _ and -.
std::string plain_name(std::string_view name);

}  // namespace sinew::identify
