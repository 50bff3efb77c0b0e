/// @file
/// How a factorisation ended.
#pragma once

namespace sinew::linalg {

enum class FactorStatus {
  positive_definite,  ///< all pivots positive
  indefinite,         ///< finished, with some negative pivots (see negative_pivots())
  singular,           ///< a pivot vanished relative to its column; results are not usable
};

}  // namespace sinew::linalg
