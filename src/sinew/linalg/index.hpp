/// @file
/// Numbers of block rows and columns, and their use as places in arrays.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>

namespace sinew::linalg {

using Index = std::int32_t;

template <std::integral T>
constexpr std::size_t at(T i) {
  return static_cast<std::size_t>(i);
}

}  // namespace sinew::linalg
