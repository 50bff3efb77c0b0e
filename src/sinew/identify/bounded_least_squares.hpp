/// @file
/// Bounded least squares by a trust region. Internal to this folder; Ceres is named in its source
/// alone.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace sinew::identify {

struct BoundedValue {
  double value = 0.0;  ///< where it starts, and where it ends
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// Ceres' own.
struct BoundedSettings {
  int max_iterations = 100;
  double function_tolerance = 1e-10;
  double parameter_tolerance = 1e-10;
  double gradient_tolerance = 1e-14;
};

struct BoundedResult {
  double cost = 0.0;       ///< |residuals|^2
  int iterations = 0;      ///< steps tried
  bool usable = false;     ///< values are feasible, and cost is theirs
  bool converged = false;  ///< by one of the tolerances
};

/// Fills residuals (rows,) and, unless null, their derivatives (rows, values), row-major. False
/// where they cannot be had.
using BoundedResiduals =
    std::function<bool(const double* values, double* residuals, double* derivatives)>;

/// Lessens |residuals|^2 within the values' bounds.
/// @param residuals with derivatives. @param rows how many residuals. @param values in and out.
/// @param settings when it ends.
BoundedResult solve_bounded(const BoundedResiduals& residuals, std::size_t rows,
                            std::vector<BoundedValue>& values, const BoundedSettings& settings);

/// The same by central differences. @param residuals (values, residuals) -> bool.
/// @param rows,values,settings as above.
BoundedResult solve_bounded_by_differences(
    const std::function<bool(const double* values, double* residuals)>& residuals, std::size_t rows,
    std::vector<BoundedValue>& values, const BoundedSettings& settings);

}  // namespace sinew::identify
