/// @file
/// Type of block row and column numbers, and its conversion to array positions.
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
