/// @file
/// The derivatives of internal forces that a step may use.
#pragma once

namespace sinew::mechanics {

/// Which derivative of the internal force is used.
enum class Tangent {
  real_time,  ///< what the body offers for one linearisation a step (corotational: R K0 R^T); SPD
  exact,      ///< the exact derivative df/dq, which may be indefinite
};

}  // namespace sinew::mechanics
