/// @file
/// What a controller is asked of the forces of a contact.
#pragma once

#include <limits>
#include <optional>

namespace sinew::inverse {

/// Forces of all points of one contact together. They come before targets: of an effector's error
/// as much is left as they need (see kForceWeight in force_rows.cpp).
struct ContactTask {
  int contact = 0;  ///< of sim::Model::contacts()
  /// N, limits of the sum of the normal forces; equal for a force that is asked for.
  double normal_min = 0.0, normal_max = std::numeric_limits<double>::infinity();
  /// The resultant stays within the friction cone less this part: |F_t| <= (1 - reserve) mu F_n,
  /// 0 <= reserve < 1. None: it may slip.
  std::optional<double> reserve;
};

}  // namespace sinew::inverse
