#include "sinew/identify/bounded_least_squares.hpp"

#include <algorithm>
#include <cmath>

#include <ceres/ceres.h>

namespace sinew::identify {

namespace {

using Differentiated = std::function<bool(const double* values, double* residuals)>;

/// A cost function with all values in one block.
class Cost : public ceres::CostFunction {
 public:
  Cost(const BoundedResiduals& residuals, std::size_t rows, std::size_t values)
      : residuals_(residuals) {
    set_num_residuals(static_cast<int>(rows));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(values));
  }
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    return residuals_(blocks[0], residuals, jacobians == nullptr ? nullptr : jacobians[0]);
  }

 private:
  const BoundedResiduals& residuals_;
};

struct Block {
  const Differentiated* residuals;
  bool operator()(double const* const* blocks, double* result) const {
    return (*residuals)(blocks[0], result);
  }
};

BoundedResult minimise(ceres::CostFunction* cost, std::vector<BoundedValue>& values,
                       const BoundedSettings& settings) {
  std::vector<double> x;
  for (const BoundedValue& value : values) x.push_back(value.value);
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, x.data());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto [value, lower, upper] = values[k];
    const int index = static_cast<int>(k);
    if (std::isfinite(lower)) problem.SetParameterLowerBound(x.data(), index, lower);
    if (std::isfinite(upper)) problem.SetParameterUpperBound(x.data(), index, upper);
  }
  ceres::Solver::Options options;
  options.max_num_iterations = settings.max_iterations;
  options.function_tolerance = settings.function_tolerance;
  options.parameter_tolerance = settings.parameter_tolerance;
  options.gradient_tolerance = settings.gradient_tolerance;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (std::size_t k = 0; k < values.size(); ++k) values[k].value = x[k];
  return {.cost = 2.0 * summary.final_cost,
          .iterations = static_cast<int>(summary.iterations.size()) - 1,
          .usable = summary.IsSolutionUsable(),
          .converged = summary.termination_type == ceres::CONVERGENCE};
}

}  // namespace

BoundedResult solve_bounded(const BoundedResiduals& residuals, std::size_t rows,
                            std::vector<BoundedValue>& values, const BoundedSettings& settings) {
  return minimise(new Cost(residuals, rows, values.size()), values, settings);
}

BoundedResult solve_bounded_by_differences(const Differentiated& residuals, std::size_t rows,
                                           std::vector<BoundedValue>& values,
                                           const BoundedSettings& settings) {
  auto* cost =
      new ceres::DynamicNumericDiffCostFunction<Block, ceres::CENTRAL>(new Block{&residuals});
  cost->SetNumResiduals(static_cast<int>(rows));
  cost->AddParameterBlock(static_cast<int>(values.size()));
  return minimise(cost, values, settings);
}

}  // namespace sinew::identify
