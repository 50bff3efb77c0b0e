/// @file
/// A requirement on the forces of a contact, for a controller.
#pragma once

#include <limits>
#include <optional>

namespace sinew::control {

/// Requirement on the total force of one contact. It comes before targets: they give way as far as
/// the forces need (see kForceWeight in force_rows.cpp).
struct ContactTask {
  int contact = 0;  ///< index in model::Model::contacts()
  /// N, limits of the sum of the normal forces; equal limits ask for one force.
  double normal_min = 0.0, normal_max = std::numeric_limits<double>::infinity();
  /// The resultant stays within the reduced friction cone |F_t| <= (1 - reserve) mu F_n,
  /// 0 <= reserve < 1. None: the contact may slip.
  std::optional<double> reserve;
};

}  // namespace sinew::control
