/// @file
/// Magnitudes of quantities of soft robots, to recognise numbers whose unit was forgotten.
#pragma once

#include <string>

#include "sinew/core/notice.hpp"
#include "sinew/core/quantity.hpp"

namespace sinew {

/// What a number is, where its dimension does not tell: a stiffness and a force per length are both
/// in N/m, a modulus, a pressure and a force per area in Pa. `none`: robots have it in any size.
enum class Usual {
  none,
  pressure,
  modulus,
  force_per_area,
  energy_per_volume,
  density,
  stiffness,
  force_per_length,
  mass,
};

/// The range of a quantity; a number in SI units outside it is probably in another unit.
struct UsualRange {
  Usual usual = Usual::none;
  Dimension dimension;
  double least = 0.0, most = 0.0;  ///< SI
  const char* name = "";           ///< "a pressure"
  const char* smaller = "";        ///< the unit that was probably meant by a number below `least`
  const char* larger = "";         ///< ... and by a number above `most`
};

/// The range of a quantity; null for Usual::none.
const UsualRange* usual_range(Usual usual);

/// Whether a number other than 0 is outside a range. @param range of its quantity.
/// @param value SI; its sign does not count.
bool is_unusual(const UsualRange& range, double value);

/// The notice about such a number. @param range,value the number. @param written as the user wrote
/// it. @param place where.
Notice unusual_notice(const UsualRange& range, double value, const std::string& written,
                      const Location& place);

}  // namespace sinew
