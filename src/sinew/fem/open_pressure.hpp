/// @file
/// The unsymmetric part that pressure on an open surface has in a tangent, for which the factor
/// knows the symmetric part alone.
#pragma once

#include <cstdint>
#include <span>

#include "sinew/core/types.hpp"

namespace sinew::linalg {
class Factorisation;
}

namespace sinew::fem {

/// A block of a matrix over free nodes.
struct FreeBlock {
  std::int32_t row = 0, column = 0;
  Matrix3 value;
};

/// dq of (A + B) dq = r. Allocates.
/// @param blocks of B, where they are not zero. @param held see FemModel::held().
/// @param factor of A. @param motion (3 free,) A^-1 r, which becomes dq.
void correct_for_open_pressure(std::span<const FreeBlock> blocks,
                               std::span<const std::int32_t> held, linalg::Factorisation& factor,
                               VectorX& motion);

}  // namespace sinew::fem
