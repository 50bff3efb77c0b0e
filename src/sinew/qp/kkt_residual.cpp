#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/qp/quadratic_program.hpp"

namespace sinew::qp {

namespace {

/// Sizes that make the conditions dimensionless, in the variables D x with D^2 = diag G, 1 where
/// that is 0.
struct Scales {
  VectorX variable;       ///< D
  double point = 0.0;     ///< max |D x|
  double gradient = 0.0;  ///< largest single term of D^-1 (G x + g - y - C^T z)
};

double relative(double value, double scale) {
  return value == 0.0 ? 0.0 : std::abs(value) / std::max(scale, std::numeric_limits<double>::min());
}

/// Violation of lower <= value <= upper together with its multiplier: infeasibility, wrong sign of
/// the multiplier, and complementarity as min(slack, multiplier), all relative.
double limit_residual(double value, double lower, double upper, double multiplier,
                      double value_scale, double multiplier_scale) {
  const auto slack = [&](double distance, double limit) {
    return std::isfinite(limit) ? relative(distance, value_scale + std::abs(limit))
                                : std::numeric_limits<double>::infinity();
  };
  double worst = 0.0;
  if (value < lower) worst = std::max(worst, slack(value - lower, lower));
  if (value > upper) worst = std::max(worst, slack(value - upper, upper));
  const double size = relative(multiplier, multiplier_scale);
  if (multiplier > 0.0) worst = std::max(worst, std::min(size, slack(value - lower, lower)));
  if (multiplier < 0.0) worst = std::max(worst, std::min(size, slack(value - upper, upper)));
  return worst;
}

double stationarity(const QuadraticProgram& problem, const QpResult& result, const MatrixX& hessian,
                    Scales* scales) {
  VectorX terms = hessian.cwiseAbs() * result.x.cwiseAbs() + problem.gradient.cwiseAbs() +
                  result.bound_multiplier.cwiseAbs();
  VectorX rest = hessian * result.x + problem.gradient - result.bound_multiplier;
  for (Eigen::Index i = 0; i < problem.rows.rows(); ++i) {
    terms += (problem.rows.row(i) * result.row_multiplier[i]).cwiseAbs().transpose();
    rest -= (problem.rows.row(i) * result.row_multiplier[i]).transpose();
  }
  scales->gradient = terms.cwiseQuotient(scales->variable).maxCoeff();
  return relative(rest.cwiseQuotient(scales->variable).cwiseAbs().maxCoeff(), scales->gradient);
}

}  // namespace

double kkt_residual(const QuadraticProgram& problem, const QpResult& result) {
  const Eigen::Index n = problem.gradient.size();
  if (n == 0) return 0.0;
  const bool finite = result.x.allFinite() && result.bound_multiplier.allFinite() &&
                      result.row_multiplier.allFinite();
  if (!finite) return std::numeric_limits<double>::infinity();
  const MatrixX hessian = problem.hessian.selfadjointView<Eigen::Lower>();
  Scales scales;
  scales.variable = hessian.diagonal().unaryExpr(
      [](double diagonal) { return diagonal > 0.0 ? std::sqrt(diagonal) : 1.0; });
  scales.point = result.x.cwiseProduct(scales.variable).cwiseAbs().maxCoeff();

  double worst = stationarity(problem, result, hessian, &scales);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double scale = scales.variable[i];
    worst = std::max(worst, limit_residual(result.x[i], problem.lower[i], problem.upper[i],
                                           result.bound_multiplier[i], scales.point / scale,
                                           scales.gradient * scale));
  }
  for (Eigen::Index i = 0; i < problem.rows.rows(); ++i) {
    const VectorX normal = problem.rows.row(i).transpose();
    const double length = normal.cwiseQuotient(scales.variable).norm();
    worst = std::max(worst, limit_residual(normal.dot(result.x), problem.row_lower[i],
                                           problem.row_upper[i], result.row_multiplier[i],
                                           scales.point * length, scales.gradient / length));
  }
  return worst;
}

}  // namespace sinew::qp
