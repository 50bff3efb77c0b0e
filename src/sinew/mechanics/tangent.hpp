/// @file
/// The derivatives of internal forces that a step may use.
#pragma once

namespace sinew::mechanics {

/// Which derivative of the internal force is used.
enum class Tangent {
  real_time,  ///< the cheapest that the body offers (corotational: R K0 R^T); SPD
  projected,  ///< the exact derivative, projected piece by piece to be positive semi-definite
  exact,      ///< the exact derivative df/dq, which may be indefinite
};

}  // namespace sinew::mechanics
