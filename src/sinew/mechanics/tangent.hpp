/// @file
/// Derivatives of the internal force that a step may use.
#pragma once

#include <optional>
#include <string_view>

namespace sinew::mechanics {

/// Which derivative of the internal force a step uses.
enum class Tangent {
  /// Corotational elements: R K_0 R^T with the rotation held fixed, positive semidefinite. Other
  /// elements: as `projected`. Arms: the exact derivative, made positive definite.
  corotated,
  projected,  ///< the exact derivative, with each element's part projected to be semidefinite
  exact,      ///< the exact derivative df/dq, which may be indefinite
};

/// Name: "corotated", "projected" or "exact".
std::string_view tangent_name(Tangent tangent);

/// The tangent with this name; none for any other word.
std::optional<Tangent> tangent_of(std::string_view word);

}  // namespace sinew::mechanics
