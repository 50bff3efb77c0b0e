/// @file
/// Names of the world axes.
#pragma once

#include <array>

namespace sinew {

inline constexpr std::array<const char*, 3> kAxisNames = {"x", "y", "z"};

}  // namespace sinew
