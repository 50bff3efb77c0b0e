/// @file
/// The derivatives of internal forces that a step may use.
#pragma once

#include <optional>
#include <string_view>

namespace sinew::mechanics {

/// Which derivative of the internal force is used.
enum class Tangent {
  /// Corotational elements: R K0 R^T with the rotation held fixed, positive semi-definite; other
  /// elements as projected. An arm: made definite.
  corotated,
  projected,  ///< the exact derivative, projected piece by piece to be positive semi-definite
  exact,      ///< the exact derivative df/dq, which may be indefinite
};

/// "corotated", "projected", "exact".
std::string_view tangent_name(Tangent tangent);

/// The tangent of that name; nothing for any other word.
std::optional<Tangent> tangent_of(std::string_view word);

}  // namespace sinew::mechanics
