/// @file
/// Units: what a unit expression such as "kg/m^3" stands for.
#pragma once

#include <string>
#include <string_view>

#include "sinew/core/quantity.hpp"

namespace sinew {

/// One of the unit is `numerator / denominator` SI units. Kept as a fraction because powers of ten
/// are exact that way: 1.1 mm is 1.1 / 1000, correctly rounded, while 1.1 * 0.001 is not.
struct Unit {
  double numerator = 1.0;
  double denominator = 1.0;
  Dimension dimension;

  double to_si(double value) const { return value * numerator / denominator; }
};

/// The product, its fraction in lowest terms where one part is a multiple of the other.
Unit operator*(const Unit& a, const Unit& b);
/// 1 / unit.
Unit inverse(const Unit& unit);
/// The unit to an integer power.
Unit power(const Unit& unit, int exponent);

/// Parses a whole unit expression; empty text is the unit 1. Throws Error(unknown-unit) at `place`,
/// with the nearest known name as the remedy.
Unit parse_unit_expression(std::string_view text, const Location& place);

/// "kg m^-3"; "1" without dimension.
std::string si_unit_name(Dimension dimension);

}  // namespace sinew
