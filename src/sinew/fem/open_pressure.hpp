/// @file
/// Correction for the unsymmetric stiffness of pressure on an open surface; only the symmetric part
/// is factorised.
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

/// Solves (A + B) dq = r, or (A + B^T) dq = r, by GMRES, preconditioned by the factor of A.
/// Allocates.
/// @param blocks non-zero blocks of B. @param held see FemModel::held().
/// @param factor of A. @param motion (3 free,) in: A^-1 r; out: dq. @param transposed B^T for B.
void correct_for_open_pressure(std::span<const FreeBlock> blocks,
                               std::span<const std::int32_t> held, linalg::Factorisation& factor,
                               VectorX& motion, bool transposed);

}  // namespace sinew::fem
