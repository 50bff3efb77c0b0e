/// @file
/// Residual of a finite-element body due to rounding.
#pragma once

#include <cstdint>
#include <span>

#include "sinew/core/types.hpp"
#include "sinew/linalg/block_pattern.hpp"

namespace sinew::fem {

/// A bound on the residual that rounding leaves, N.
/// @param pattern,matrix A, with stiffness and inertia of the elements.
/// @param held coordinates to leave out. @param largest coordinate of the body, m.
/// @param sum scratch, resized.
double rounding_floor(const linalg::BlockPattern& pattern, std::span<const double> matrix,
                      std::span<const std::int32_t> held, double largest, VectorX& sum);

}  // namespace sinew::fem
