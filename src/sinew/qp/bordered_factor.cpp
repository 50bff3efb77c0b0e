#include "sinew/qp/bordered_factor.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include "sinew/linalg/dense_kernels.hpp"
#include "sinew/linalg/index.hpp"
#include "sinew/qp/dense_lu.hpp"

namespace sinew::qp {

namespace {

constexpr int kNode = 3;    // the kernels take columns by threes
constexpr int kPanel = 96;  // columns whose product with the rows below fits the cache
constexpr int kStrip = 24;  // columns of D at a time

using linalg::at;

int whole_nodes(int count) { return (count + kNode - 1) / kNode * kNode; }

}  // namespace

void BorderedFactor::reshape(int leading, int rest) {
  leading_ = leading;
  rest_ = rest;
  padded_ = whole_nodes(leading);
  height_ = padded_ + 2 * rest + linalg::kOverrun;
  reserve(leading + rest);
  corner_ = numbers_.data() + std::ptrdiff_t{padded_} * height_;
}

// Allocates for every shape with this many rows.
void BorderedFactor::reserve(int size) {
  if (pivot_.size() >= at(size)) return;
  const int room = std::max(size, 3 * static_cast<int>(pivot_.size()) / 2);
  const int columns = room + kNode - 1, rows = columns + linalg::kOverrun;
  numbers_.resize(at(columns) * at(rows) + linalg::kOverrun);
  pivot_.resize(at(room));
  inverse_.resize(at(columns));
  sign_.resize(at(columns));
  scratch_.resize(at(2 * kNode * columns));
  product_.resize(at(kStrip * rows));
  vector_.resize(at(2 * rows));
}

bool BorderedFactor::factorise() {
  if (leading_ > 0 && !factorise_leading()) return false;
  if (leading_ > 0 && rest_ > 0) subtract_product();
  return eliminate(corner(), std::span(pivot_).first(at(rest_)));
}

bool BorderedFactor::factorise_leading() {
  for (int j = 0; j < padded_; ++j) {
    double* const column = numbers_.data() + std::ptrdiff_t{j} * height_;
    if (j >= leading_) std::fill_n(column, height_, 0.0);
    for (int i = leading_; i < padded_; ++i) column[i] = i == j ? 1.0 : 0.0;
    std::fill_n(column + padded_ + 2 * rest_, linalg::kOverrun, 0.0);
    inverse_[at(j)] = column[j];
  }
  const int rows = padded_ + 2 * rest_;
  for (int first = 0; first < padded_; first += kPanel) {
    const int width = std::min(kPanel, padded_ - first), below = first + width;
    const auto diagonal = [&](int j) { return numbers_.data() + j * std::ptrdiff_t{height_ + 1}; };
    double* const panel = diagonal(first);
    linalg::DiagonalBlock block{.panel = panel,
                                .leading = height_,
                                .columns = width,
                                .inverse = inverse_.data() + first,
                                .sign = sign_.data() + first,
                                .scratch = scratch_.data()};
    linalg::factorise_panel(block, rows - first);
    if (block.singular || block.negatives > 0) return false;
    if (below == padded_) break;
    const double* const factor = panel + width;
    linalg::multiply({factor, height_, factor, height_, width, padded_ - below}, 0, rows - below,
                     diagonal(below), height_, linalg::Store::subtract, linalg::Part::lower);
  }
  return true;
}

// D -= (R L^-T)(C^T L^-T)^T.
void BorderedFactor::subtract_product() {
  const int leading = rest_ + linalg::kOverrun;
  const double* const left = numbers_.data() + padded_;
  for (int first = 0; first < rest_; first += kStrip) {
    const int width = std::min(kStrip, rest_ - first);
    linalg::multiply({left, height_, left + rest_ + first, height_, padded_, whole_nodes(width)}, 0,
                     rest_, product_.data(), leading, linalg::Store::assign);
    corner().middleCols(first, width) -=
        Block(product_.data(), rest_, width, Eigen::OuterStride<>(leading));
  }
}

void BorderedFactor::solve(Eigen::Ref<VectorX> right) {
  Eigen::Map<VectorX> v(vector_.data(), height_);
  v.setZero();
  v.head(leading_) = right.head(leading_);
  linalg::forward_panel(numbers_.data(), height_, padded_, padded_ + rest_, inverse_.data(),
                        v.data());
  auto rest = right.tail(rest_);
  rest += v.segment(padded_, rest_);
  substitute(corner(), std::span(pivot_).first(at(rest_)), rest);
  v.tail(height_ - padded_).setZero();
  v.segment(padded_ + rest_, rest_) = rest;
  linalg::backward_panel(numbers_.data(), height_, padded_, padded_ + 2 * rest_, inverse_.data(),
                         v.data());
  right.head(leading_) = v.head(leading_);
}

}  // namespace sinew::qp
