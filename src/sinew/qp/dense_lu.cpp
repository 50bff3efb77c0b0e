#include "sinew/qp/dense_lu.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/qp/dense_kernels.hpp"

namespace sinew::qp {

namespace {

constexpr int kPanel = 8;

}  // namespace

void DenseLu::reserve(int size) {
  if (pivot_.size() >= static_cast<std::size_t>(size)) return;
  const std::size_t room = std::max(static_cast<std::size_t>(size), 3 * pivot_.size() / 2);
  storage_.resize(room * room);
  pivot_.resize(room);
}

bool DenseLu::factorise(int size) {
  size_ = size;
  for (int first = 0; first < size; first += kPanel) {
    const int width = std::min(kPanel, size - first);
    if (!factor_panel(first, width)) return false;
    apply_panel(first, width);
  }
  return true;
}

bool DenseLu::factor_panel(int first, int width) {
  auto a = matrix(size_);
  for (int k = first; k < first + width; ++k) {
    Eigen::Index below = 0;
    const double largest = a.col(k).tail(size_ - k).cwiseAbs().maxCoeff(&below);
    if (!(largest > std::numeric_limits<double>::min())) return false;
    const auto pivot = static_cast<int>(below) + k;
    pivot_[static_cast<std::size_t>(k)] = pivot;
    if (pivot != k) a.row(k).swap(a.row(pivot));
    const int rest = size_ - k - 1;
    a.col(k).tail(rest) /= a(k, k);
    for (int j = k + 1; j < first + width; ++j) {
      add_scaled(&a(k, j) + 1, -a(k, j), &a(k, k) + 1, rest);
    }
  }
  return true;
}

// Columns right of the panel: the rows of U, and the rank-`width` update below them.
void DenseLu::apply_panel(int first, int width) {
  auto a = matrix(size_);
  const int end = first + width, rest = size_ - end;
  for (int j = end; j < size_; ++j) {
    double* column = &a(0, j);
    for (int k = first; k < end; ++k) {
      add_scaled(column + k + 1, -column[k], &a(k, k) + 1, end - k - 1);
    }
    if (rest == 0) continue;
    if (width < kPanel) {
      for (int k = first; k < end; ++k) add_scaled(column + end, -column[k], &a(end, k), rest);
      continue;
    }
    Eigen::Map<VectorX> below(column + end, rest);
    const Eigen::Map<const Eigen::Matrix<double, kPanel, 1>> factors(column + first);
    for (int k = 0; k < kPanel; k += 4) {
      below -= a.col(first + k).tail(rest) * factors[k] +
               a.col(first + k + 1).tail(rest) * factors[k + 1] +
               a.col(first + k + 2).tail(rest) * factors[k + 2] +
               a.col(first + k + 3).tail(rest) * factors[k + 3];
    }
  }
}

void DenseLu::solve(Eigen::Ref<VectorX> right) const {
  const Eigen::Map<const MatrixX> a(storage_.data(), size_, size_);
  for (int k = 0; k < size_; ++k) {
    std::swap(right[k], right[pivot_[static_cast<std::size_t>(k)]]);
  }
  for (int k = 0; k + 1 < size_; ++k) {
    right.tail(size_ - k - 1) -= right[k] * a.col(k).tail(size_ - k - 1);
  }
  for (int k = size_; k-- > 0;) {
    right[k] /= a(k, k);
    if (k > 0) right.head(k) -= right[k] * a.col(k).head(k);
  }
}

}  // namespace sinew::qp
