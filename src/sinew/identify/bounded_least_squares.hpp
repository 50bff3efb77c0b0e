/// @file
/// Bounded least squares by a trust region. Internal to this folder; only its source uses Ceres.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace sinew::identify {

/// A variable with bounds.
struct BoundedValue {
  double value = 0.0;  ///< initial guess, then the solution
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// Termination criteria of Ceres.
struct BoundedSettings {
  int max_iterations = 100;
  double function_tolerance = 1e-10;
  double parameter_tolerance = 1e-10;
  double gradient_tolerance = 1e-14;
};

/// Outcome of a solve.
struct BoundedResult {
  double cost = 0.0;       ///< |residuals|^2
  int iterations = 0;      ///< steps tried
  bool usable = false;     ///< values are feasible, and cost belongs to them
  bool converged = false;  ///< by one of the tolerances
};

/// Fills residuals (rows,) and, unless null, their derivatives (rows, values), row-major. Returns
/// false if they cannot be computed.
using BoundedResiduals =
    std::function<bool(const double* values, double* residuals, double* derivatives)>;

/// Minimises |residuals|^2 within the bounds of the values.
/// @param residuals with derivatives. @param rows number of residuals. @param values in and out.
/// @param settings termination criteria.
BoundedResult solve_bounded(const BoundedResiduals& residuals, std::size_t rows,
                            std::vector<BoundedValue>& values, const BoundedSettings& settings);

/// The same with central differences. @param residuals (values, residuals) -> bool.
/// @param rows,values,settings as above.
BoundedResult solve_bounded_by_differences(
    const std::function<bool(const double* values, double* residuals)>& residuals, std::size_t rows,
    std::vector<BoundedValue>& values, const BoundedSettings& settings);

}  // namespace sinew::identify
