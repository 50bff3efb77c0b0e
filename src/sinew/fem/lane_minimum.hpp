/// @file
/// The smallest volume ratio of many elements, eight at a time.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "sinew/fem/element_kernel.hpp"
#include "sinew/material/lanes.hpp"

namespace sinew::fem {

/// The smallest det F so far in each lane, and the batch in which it occurred.
struct LaneMinimum {
  material::Lanes value = material::lanes(std::numeric_limits<double>::infinity());
  material::LaneMask batch{};

  SINEW_INLINE void see(const material::Lanes& ratio, std::int64_t in_batch) {
    const material::Lanes lost = material::lanes(-std::numeric_limits<double>::infinity());
    // NOLINTNEXTLINE(misc-redundant-expression): false where a lane is NaN
    const material::Lanes finite = ratio == ratio ? ratio : lost;
    const material::LaneMask smaller = finite < value;
    const material::LaneMask here = material::LaneMask{} + in_batch;
    value = smaller ? finite : value;
    batch = smaller ? here : batch;
  }
};

/// The smallest ratio over all lanes, and its slot (of equal ones, the lowest).
/// @param minimum over batches. @param element of each slot, -1 in padding lanes.
/// @param first_slot added to the slot.
inline SmallestRatio smallest(const LaneMinimum& minimum, std::span<const std::int32_t> element,
                              std::int64_t first_slot) {
  SmallestRatio result{std::numeric_limits<double>::infinity(), -1};
  for (int lane = 0; lane < material::kLanes; ++lane) {
    const std::int64_t own = material::kLanes * minimum.batch[lane] + lane;
    if (element[static_cast<std::size_t>(own)] < 0) continue;
    const auto slot = static_cast<std::int32_t>(first_slot + own);
    const double value = minimum.value[lane];
    if (value < result.value || (value == result.value && slot < result.slot)) {
      result = {value, slot};
    }
  }
  return result;
}

}  // namespace sinew::fem
