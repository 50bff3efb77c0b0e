/// @file
/// Statistics of fits.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::identify {

/// Quantile of Student's t. @param probability between 0 and 1. @param degrees_of_freedom 1 or
/// more.
double student_quantile(double probability, int degrees_of_freedom);

/// Normalised root mean square error |predicted - measured| / |measured - mean|, over all columns
/// and all measured entries (not NaN); each column has its own mean.
/// @param predicted,measured (samples, columns). Throws Error: wrong-length, out-of-range if the
///   measurements do not vary.
double nrmse(const MatrixX& predicted, const MatrixX& measured);

}  // namespace sinew::identify
