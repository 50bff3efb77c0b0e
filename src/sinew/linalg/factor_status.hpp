/// @file
/// Result of a factorisation.
#pragma once

namespace sinew::linalg {

/// Result of a factorisation.
enum class FactorStatus {
  positive_definite,  ///< all pivots positive
  indefinite,         ///< finished, with some negative pivots (see negative_pivots())
  singular,           ///< a pivot vanished; the results must not be used
};

}  // namespace sinew::linalg
