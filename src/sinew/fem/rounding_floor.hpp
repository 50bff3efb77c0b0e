/// @file
/// What rounding leaves of the residual of a finite-element body.
#pragma once

#include <cstdint>
#include <span>

#include "sinew/linalg/block_pattern.hpp"

namespace sinew::fem {

/// A bound, N. @param pattern,matrix A, which holds the elements' stiffness and inertia.
/// @param held coordinates that are not part of it. @param largest coordinate of the body, m.
double rounding_floor(const linalg::BlockPattern& pattern, std::span<const double> matrix,
                      std::span<const std::int32_t> held, double largest);

}  // namespace sinew::fem
