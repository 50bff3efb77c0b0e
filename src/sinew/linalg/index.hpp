/// @file
/// Numbers of block rows and columns, and their use as places in arrays.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sinew::linalg {

using Index = std::int32_t;

constexpr std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace sinew::linalg
