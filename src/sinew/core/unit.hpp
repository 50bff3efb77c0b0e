/// @file
/// Units and unit expressions such as "kg/m^3".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sinew/core/quantity.hpp"

namespace sinew {

/// A unit: one of it is `numerator / denominator` SI units. A fraction keeps powers of ten exact:
/// 1.1 mm is 1.1 / 1000, correctly rounded, while 1.1 * 0.001 is not.
struct Unit {
  double numerator = 1.0;
  double denominator = 1.0;
  Dimension dimension;

  double to_si(double value) const { return value * numerator / denominator; }
};

/// The product; its fraction is reduced if one part is a multiple of the other.
Unit operator*(const Unit& a, const Unit& b);
/// 1 / unit.
Unit inverse(const Unit& unit);
/// The unit to an integer power.
Unit power(const Unit& unit, int exponent);

/// Parses a unit expression; empty text is the unit 1. Throws Error(unknown-unit) at `place`, for
/// an unknown name with the nearest known one as the remedy. If `expected`, the dimension of the
/// quantity, is given, the remedy for an unknown name that stands alone is a unit of it.
Unit parse_unit_expression(std::string_view text, const Location& place,
                           std::optional<Dimension> expected = {});

/// Name in SI base units such as "kg m^-3"; "1" if dimensionless.
std::string si_unit_name(Dimension dimension);

}  // namespace sinew
