/// @file
/// Magnitudes of quantities of soft robots, to recognise numbers whose unit was forgotten.
#pragma once

#include <string>

#include "sinew/core/notice.hpp"
#include "sinew/core/quantity.hpp"

namespace sinew {

/// The range of a quantity; a number in SI units outside it is probably in another unit.
struct UsualRange {
  Dimension dimension;
  double least = 0.0, most = 0.0;  ///< SI
  const char* name = "";           ///< "a pressure or modulus"
  const char* smaller = "";        ///< the unit that was probably meant by a number below `least`
  const char* larger = "";         ///< ... and by a number above `most`
};

/// The range of a dimension: pressures (and moduli), densities, stiffnesses, masses; else null.
const UsualRange* usual_range(Dimension dimension);

/// Whether a number other than 0 is outside a range. @param range of its dimension.
/// @param value SI; its sign does not count.
bool is_unusual(const UsualRange& range, double value);

/// The notice about such a number. @param range,value the number. @param written as the user wrote
/// it. @param place where.
Notice unusual_notice(const UsualRange& range, double value, const std::string& written,
                      const Location& place);

}  // namespace sinew
