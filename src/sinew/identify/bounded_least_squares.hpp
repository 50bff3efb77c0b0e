/// @file
/// Bounded least squares over parameters of one block each, by Ceres.
/// Internal to this folder: it needs Ceres' headers.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <ceres/ceres.h>

namespace sinew::identify {

struct BoundedValue {
  double value = 0.0;  ///< where it starts, and where it ends
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// Lessens 1/2 |residuals|^2 by a trust region. Cost is of that form.
/// @param cost over blocks of one parameter each.
/// @param values in and out.
/// @param max_iterations,function_tolerance Ceres' own.
inline ceres::Solver::Summary solve_bounded(std::unique_ptr<ceres::CostFunction> cost,
                                            std::vector<BoundedValue>& values, int max_iterations,
                                            double function_tolerance) {
  ceres::Problem problem;
  std::vector<double*> blocks;
  for (BoundedValue& value : values) blocks.push_back(&value.value);
  problem.AddResidualBlock(cost.release(), nullptr, blocks);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto [value, lower, upper] = values[k];
    if (std::isfinite(lower)) problem.SetParameterLowerBound(blocks[k], 0, lower);
    if (std::isfinite(upper)) problem.SetParameterUpperBound(blocks[k], 0, upper);
  }
  ceres::Solver::Options options;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = function_tolerance;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-10;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

/// The same with derivatives by central differences.
/// @param residuals (values, residuals) -> bool, false where they cannot be had.
/// @param rows how many residuals.
/// @param values,max_iterations,function_tolerance as above.
template <typename Residuals>
ceres::Solver::Summary solve_bounded(Residuals residuals, std::size_t rows,
                                     std::vector<BoundedValue>& values, int max_iterations,
                                     double function_tolerance) {
  using Cost = ceres::DynamicNumericDiffCostFunction<Residuals, ceres::CENTRAL>;
  auto cost = std::make_unique<Cost>(new Residuals(std::move(residuals)));
  cost->SetNumResiduals(static_cast<int>(rows));
  for (std::size_t k = 0; k < values.size(); ++k) cost->AddParameterBlock(1);
  return solve_bounded(std::move(cost), values, max_iterations, function_tolerance);
}

}  // namespace sinew::identify
