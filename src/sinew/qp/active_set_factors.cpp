#include "sinew/qp/active_set_factors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/qp/padded_columns.hpp"

namespace sinew::qp {

ActiveSetFactors::ActiveSetFactors(int variables)
    : size_(variables), stride_(padded_length(variables)) {
  const Eigen::Index entries = static_cast<Eigen::Index>(stride_) * size_;
  lower_.setZero(entries);
  basis_.setZero(entries);
  triangle_.setZero(entries);
  projection_.setZero(stride_);
  direction_.setZero(stride_);
  exchange_.setZero(stride_);
  scratch_.setZero(stride_);
}

bool ActiveSetFactors::factorise(const MatrixX& hessian) {
  active_ = 0;
  if (!cholesky(hessian)) return false;
  invert_transpose();
  return true;
}

// Left-looking by columns. The rows above the diagonal of a column keep stale values that nothing
// reads.
bool ActiveSetFactors::cholesky(const MatrixX& hessian) {
  const double threshold = 4.0 * size_ * std::numeric_limits<double>::epsilon();
  for (int j = 0; j < size_; ++j) {
    double* target = lower_.data() + static_cast<Eigen::Index>(j) * stride_;
    const double* source = hessian.data() + static_cast<Eigen::Index>(j) * hessian.outerStride();
    std::copy(source + j, source + size_, target + j);
    for (int k = 0; k < j; ++k) {
      const double* previous = lower_.data() + static_cast<Eigen::Index>(k) * stride_;
      add_scaled(target + j, -previous[j], previous + j, size_ - j);
    }
    const double pivot = target[j];
    if (!(pivot > threshold * source[j]) || !std::isfinite(pivot)) return false;
    const double inverse = 1.0 / std::sqrt(pivot);
    for (int i = j; i < size_; ++i) target[i] *= inverse;
  }
  return true;
}

// J L^T = I column by column: J_j = (e_j - sum_{k<j} L_jk J_k) / L_jj.
void ActiveSetFactors::invert_transpose() {
  for (int j = 0; j < size_; ++j) {
    double* target = column(j);
    std::fill(target, target + stride_, 0.0);
    for (int k = 0; k < j; ++k) {
      const double entry = lower_[static_cast<Eigen::Index>(k) * stride_ + j];
      add_scaled(target, -entry, column(k), padded_length(k + 1));
    }
    const double inverse = 1.0 / lower_[static_cast<Eigen::Index>(j) * stride_ + j];
    for (int i = 0; i < j; ++i) target[i] *= inverse;
    target[j] = inverse;
  }
}

void ActiveSetFactors::multiply_transpose(const double* v, double* product) const {
  for (int j = 0; j < size_; ++j) product[j] = dot(column(j), v, stride_);
}

void ActiveSetFactors::project(const double* normal) {
  multiply_transpose(normal, projection_.data());
}

void ActiveSetFactors::project_unit(int i) {
  for (int j = 0; j < size_; ++j) projection_[j] = column(j)[i];
}

void ActiveSetFactors::compute_directions() {
  const double* d = projection_.data();
  const int rest = size_ - active_;
  independent_part_ = dot(d + active_, d + active_, rest);
  whole_part_ = independent_part_ + dot(d, d, active_);
  std::fill(direction_.begin(), direction_.end(), 0.0);
  for (int j = active_; j < size_; ++j) add_scaled(direction_.data(), d[j], column(j), stride_);
  std::copy(d, d + active_, exchange_.data());
  for (int j = active_ - 1; j >= 0; --j) {
    const double value = exchange_[j] / triangle(j)[j];
    exchange_[j] = value;
    add_scaled(exchange_.data(), -value, triangle(j), j);
  }
}

// The reflection I - b v v^T with v = d2 - a e_1, a = -+|d2|, takes d2 to a e_1. J2 v needs no new
// product: it is z - a times the first column of J2.
void ActiveSetFactors::add() {
  const double first = projection_[active_];
  const double length = std::sqrt(independent_part_);
  const double reflected = first > 0.0 ? -length : length;
  const double factor = 1.0 / (independent_part_ - reflected * first);
  double* image = scratch_.data();
  std::copy(direction_.begin(), direction_.end(), image);
  add_scaled(image, -reflected, column(active_), stride_);
  add_scaled(column(active_), -factor * (first - reflected), image, stride_);
  for (int j = active_ + 1; j < size_; ++j) {
    add_scaled(column(j), -factor * projection_[j], image, stride_);
  }
  double* last = triangle(active_);
  std::copy(projection_.data(), projection_.data() + active_, last);
  last[active_] = reflected;
  ++active_;
}

void ActiveSetFactors::drop(int position) {
  for (int j = position; j + 1 < active_; ++j) {
    std::copy(triangle(j + 1), triangle(j + 1) + j + 2, triangle(j));
  }
  --active_;
  for (int j = position; j < active_; ++j) {
    const double length = std::hypot(triangle(j)[j], triangle(j)[j + 1]);
    if (length == 0.0) continue;
    const double c = triangle(j)[j] / length;
    const double s = triangle(j)[j + 1] / length;
    for (int k = j; k < active_; ++k) {
      double* pair = triangle(k) + j;
      const double upper = pair[0];
      pair[0] = c * upper + s * pair[1];
      pair[1] = c * pair[1] - s * upper;
    }
    double* __restrict left = column(j);
    double* __restrict right = column(j + 1);
    for (int i = 0; i < stride_; ++i) {
      const double old = left[i];
      left[i] = c * old + s * right[i];
      right[i] = c * right[i] - s * old;
    }
  }
}

// x = J w with R^T w1 = values, w2 = -J2^T gradient, and R multipliers = w1 + J1^T gradient.
void ActiveSetFactors::solve_equality(const double* gradient, const double* values, double* x,
                                      double* multipliers) {
  double* w = scratch_.data();
  multiply_transpose(gradient, w);
  for (int j = 0; j < active_; ++j) {
    const double range = (values[j] - dot(triangle(j), exchange_.data(), j)) / triangle(j)[j];
    exchange_[j] = range;
    multipliers[j] = range + w[j];
  }
  std::fill(x, x + stride_, 0.0);
  for (int j = 0; j < active_; ++j) add_scaled(x, exchange_[j], column(j), stride_);
  for (int j = active_; j < size_; ++j) add_scaled(x, -w[j], column(j), stride_);
  for (int j = active_ - 1; j >= 0; --j) {
    multipliers[j] /= triangle(j)[j];
    add_scaled(multipliers, -multipliers[j], triangle(j), j);
  }
}

double ActiveSetFactors::dual_norm(const double* v) const {
  double sum = 0.0;
  for (int j = 0; j < size_; ++j) {
    const double entry = dot(column(j), v, stride_);
    sum += entry * entry;
  }
  return std::sqrt(sum);
}

}  // namespace sinew::qp
