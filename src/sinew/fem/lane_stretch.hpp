/// @file
/// The largest principal stretch of eight deformation gradients. Included by kernels only.
#pragma once

#include "sinew/material/lanes.hpp"
#include "sinew/material/principal.hpp"
#include "sinew/mechanics/step_system.hpp"

namespace sinew::fem {

/// |F|^2, the sum of the squared principal stretches. @param f F of one point.
SINEW_INLINE material::Lanes squared_norm(const material::Lanes3x3& f) {
  material::Lanes square = material::lanes(0.0);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) square += f[r][c] * f[r][c];
  }
  return square;
}

/// The largest principal stretch in each lane, or |F|, an upper bound of it, where all |F| are
/// sane. The principal stretches cost ten times as much as the bound, which nearly always suffices.
/// @param f F of one point.
SINEW_INLINE material::Lanes largest_stretch(const material::Lanes3x3& f) {
  const material::Lanes square = squared_norm(f);
  const double sane = mechanics::kSaneStretch * mechanics::kSaneStretch;
  if (!material::any(square > material::lanes(sane))) return material::square_root(square);
  const material::Principal at = material::principal(f);
  return material::maximum(material::maximum(at.stretch[0], at.stretch[1]), at.stretch[2]);
}

}  // namespace sinew::fem
