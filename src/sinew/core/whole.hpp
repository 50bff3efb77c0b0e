/// @file
/// Conversion of computed numbers to whole ones. Casting a double that is NaN or beyond the range
/// of the integer is undefined behaviour, so no computed number is cast without one of these.
#pragma once

#include <concepts>
#include <limits>
#include <string_view>

namespace sinew {

/// The integer part of a number: its nearest bound if it is beyond them, `least` if it is NaN.
/// @param value any number; round it before where the nearest integer is wanted.
/// @param least,most bounds of the result, least <= most.
template <std::integral To>
constexpr To whole(double value, To least = std::numeric_limits<To>::min(),
                   To most = std::numeric_limits<To>::max()) {
  if (!(value > static_cast<double>(least))) return least;
  if (!(value < static_cast<double>(most))) return most;  // most may round up to most + 1
  return static_cast<To>(value);
}

/// Throws Error(out-of-range) unless a computed count is within [1, most], hence finite.
/// @param count the number. @param most its largest sensible value. @param what is counted, such as
/// "time steps of a recorded motion". @param remedy what to change.
void require_count(double count, double most, std::string_view what, std::string_view remedy);

/// The integer part of a count. Throws what require_count() throws.
template <std::integral To>
To whole_count(double count, double most, std::string_view what, std::string_view remedy) {
  require_count(count, most, what, remedy);
  return whole<To>(count);
}

}  // namespace sinew
