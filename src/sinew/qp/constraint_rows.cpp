#include "sinew/qp/constraint_rows.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/qp/padded_columns.hpp"

namespace sinew::qp {

namespace {

bool sized(const VectorX& vector, int size) { return vector.size() == size; }

}  // namespace

ConstraintRows::ConstraintRows(int variables, int constraints)
    : variables_(variables), constraints_(constraints), stride_(padded_length(variables)) {
  normals_.setZero(static_cast<Eigen::Index>(stride_) * constraints_);
  lower_.setZero(count());
  upper_.setZero(count());
  weight_.setOnes(count());
  scale_.setOnes(variables_);
}

void ConstraintRows::check_shape(const QuadraticProgram& problem) const {
  const int n = variables_;
  const int m = constraints_;
  const bool objective = problem.hessian.rows() == n && problem.hessian.cols() == n &&
                         sized(problem.gradient, n) && sized(problem.lower, n) &&
                         sized(problem.upper, n);
  const bool rows = problem.rows.rows() == m && (m == 0 || problem.rows.cols() == n) &&
                    sized(problem.row_lower, m) && sized(problem.row_upper, m);
  if (objective && rows) return;
  throw Error(
      ErrorKind::wrong_shape, {.item = objective ? "rows" : "hessian, gradient or bounds"},
      fmt::format("the quadratic program does not have {} variables and {} rows: hessian "
                  "{}x{}, gradient {}, lower {}, upper {}, rows {}x{}, row limits {} and {}",
                  n, m, problem.hessian.rows(), problem.hessian.cols(), problem.gradient.size(),
                  problem.lower.size(), problem.upper.size(), problem.rows.rows(),
                  problem.rows.cols(), problem.row_lower.size(), problem.row_upper.size()),
      "make the solver for the problem's size, and the problem by QuadraticProgram::sized");
}

void ConstraintRows::check_limits() const {
  for (int c = 0; c < count(); ++c) {
    if (!(lower_[c] > upper_[c])) continue;
    const std::string name = is_bound(c) ? fmt::format("bound of variable {}", c)
                                         : fmt::format("limits of row {}", c - variables_);
    throw Error(ErrorKind::contradictory_limits, {.item = name},
                fmt::format("the lower limit {} exceeds the upper limit {}", lower_[c], upper_[c]),
                "exchange the limits, or leave one out");
  }
}

bool ConstraintRows::load(const QuadraticProgram& problem) {
  check_shape(problem);
  const auto rows = static_cast<Eigen::Index>(constraints_);
  lower_.head(variables_) = problem.lower;
  lower_.tail(rows) = problem.row_lower;
  upper_.head(variables_) = problem.upper;
  upper_.tail(rows) = problem.row_upper;
  check_limits();

  bool finite = true;
  for (int c = 0; c < count(); ++c) {
    finite = finite && lower_[c] < kInfinity && upper_[c] > -kInfinity;
  }
  for (int i = 0; i < variables_; ++i) {
    const double diagonal = problem.hessian(i, i);
    scale_[i] = diagonal > 0.0 ? std::sqrt(diagonal) : 1.0;
    weight_[i] = scale_[i];
    finite = finite && std::isfinite(problem.gradient[i]);
  }
  for (int i = 0; i < constraints_; ++i) {
    double* normal = normals_.data() + static_cast<Eigen::Index>(i) * stride_;
    double sum = 0.0;
    for (int j = 0; j < variables_; ++j) {
      normal[j] = problem.rows(i, j);
      const double scaled = normal[j] / scale_[j];
      sum += scaled * scaled;
    }
    weight_[variables_ + i] = sum > 0.0 ? 1.0 / std::sqrt(sum) : 1.0;
    finite = finite && std::isfinite(sum);
  }
  return finite;
}

double ConstraintRows::value(int c, const double* x) const {
  return is_bound(c) ? x[c] : dot(normal(c), x, stride_);
}

double ConstraintRows::magnitude(int c, const double* x) const {
  if (is_bound(c)) return std::abs(x[c]);
  const double* row = normal(c);
  double sum = 0.0;
  for (int j = 0; j < variables_; ++j) sum += std::abs(row[j] * x[j]);
  return sum;
}

void ConstraintRows::add_normal(int c, double factor, double* sum) const {
  if (is_bound(c)) {
    sum[c] += factor;
  } else {
    add_scaled(sum, factor, normal(c), stride_);
  }
}

}  // namespace sinew::qp
