/// @file
/// Product of a symmetric block matrix with a vector.
#pragma once

#include <span>

#include "sinew/linalg/block_pattern.hpp"

namespace sinew::linalg {

/// y = A x. @param pattern of A (lower triangle). @param matrix kBlockStride * blocks doubles.
/// @param x (3 n,). @param y (3 n,), must not alias x.
void multiply(const BlockPattern& pattern, std::span<const double> matrix,
              std::span<const double> x, std::span<double> y);

}  // namespace sinew::linalg
