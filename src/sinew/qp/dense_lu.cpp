#include "sinew/qp/dense_lu.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/linalg/dense_kernels.hpp"
#include "sinew/linalg/vector_lanes.hpp"
#include "sinew/qp/padded_columns.hpp"

namespace sinew::qp {

namespace {

constexpr int kPanel = 8;
// Columns of a group, which stay in the cache while finished groups of the same size update them. A
// multiple of the panel and of the three columns of a node in the kernels of products.
constexpr int kNode = 3;
constexpr int kGroup = 48;
static_assert(kGroup % kPanel == 0 && kGroup % kNode == 0);

constexpr int kTile = 4;  // columns that share the loads of a panel

// C -= A F for columns of C and `depth` of A; all have the same leading dimension.
template <int columns, int depth>
void subtract(const double* a, const double* f, std::ptrdiff_t leading, double* c, int rows) {
  using linalg::broadcast, linalg::kLanes, linalg::Lanes, linalg::load, linalg::store;
  Lanes factor[columns][depth];
  for (int j = 0; j < columns; ++j) {
    for (int k = 0; k < depth; ++k) factor[j][k] = broadcast(f[k + j * leading]);
  }
  int i = 0;
  for (; i + kLanes <= rows; i += kLanes) {
    Lanes sum[columns];
    SINEW_UNROLL
    for (int j = 0; j < columns; ++j) sum[j] = load(c + i + j * leading);
    SINEW_UNROLL
    for (int k = 0; k < depth; ++k) {
      const Lanes left = load(a + i + k * leading);
      SINEW_UNROLL
      for (int j = 0; j < columns; ++j) sum[j] -= left * factor[j][k];
    }
    SINEW_UNROLL
    for (int j = 0; j < columns; ++j) store(c + i + j * leading, sum[j]);
  }
  for (; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      for (int k = 0; k < depth; ++k) c[i + j * leading] -= a[i + k * leading] * f[k + j * leading];
    }
  }
}

class LuElimination {
 public:
  LuElimination(const Eigen::Map<MatrixX>& a, std::span<int> pivot)
      : a_(a),
        pivot_(pivot),
        size_(static_cast<int>(a.rows())),
        pivots_(static_cast<int>(pivot.size())) {}

  bool run() {
    for (int begin = 0; begin < size_; begin += kGroup) {
      const int end = std::min(begin + kGroup, size_);
      const int done = std::min(begin, pivots_);
      swap_rows(0, done, begin, end);
      for (int first = 0; first < done; first += kGroup) apply_group(first, begin, end);
      for (int first = begin; first < std::min(end, pivots_); first += kPanel) {
        if (!factor_panel(first, begin, end)) return false;
        apply_panel(first, first + width(first), end, size_);
      }
      swap_rows(begin, std::min(end, pivots_) - begin, 0, begin);
    }
    return true;
  }

 private:
  int width(int first) const { return std::min(kPanel, pivots_ - first); }

  // Makes all swaps in a column before the next one, since columns are far apart in memory.
  void swap_rows(int first, int count, int begin, int end) {
    for (int j = begin; j < end; ++j) {
      double* const column = &a_(0, j);
      for (int k = first; k < first + count; ++k) {
        const int other = pivot_[static_cast<std::size_t>(k)];
        if (other != k) std::swap(column[k], column[other]);
      }
    }
  }

  // Factorises a panel. Swaps rows in the columns begin .. end - 1 of its group only: run() swaps
  // them in the columns on the left when the group is finished, and in those on the right when they
  // are reached.
  bool factor_panel(int first, int begin, int end) {
    for (int k = first; k < first + width(first); ++k) {
      Eigen::Index below = 0;
      const double largest = a_.col(k).segment(k, pivots_ - k).cwiseAbs().maxCoeff(&below);
      if (!(largest > std::numeric_limits<double>::min())) return false;
      pivot_[static_cast<std::size_t>(k)] = static_cast<int>(below) + k;
      swap_rows(k, 1, begin, end);
      const int rest = size_ - k - 1;
      a_.col(k).tail(rest) /= a_(k, k);
      for (int j = k + 1; j < first + width(first); ++j) {
        add_scaled(&a_(k, j) + 1, -a_(k, j), &a_(k, k) + 1, rest);
      }
    }
    return true;
  }

  // Updates columns begin .. end - 1 with the finished group that starts at column `first`:
  // computes its rows of U panel by panel, and subtracts one product from all rows below.
  void apply_group(int first, int begin, int end) {
    const int last = std::min(first + kGroup, pivots_);
    for (int k = first; k < last; k += kPanel) apply_panel(k, begin, end, last);
    const int whole = (end - begin) / kNode * kNode;
    if (whole > 0) subtract_product(first, last, begin, whole);
    for (int j = begin + whole; j < end; ++j) update<1>(first, last, j, size_);
  }

  // Subtracts L U from the rows below. The kernel writes whole vectors of rows; the last,
  // incomplete one is multiplied in a separate array, because the next column begins within it.
  void subtract_product(int first, int last, int begin, int columns) {
    using linalg::kLanes;
    for (int k = first; k < last; ++k) {
      for (int j = 0; j < columns; ++j) turned_[(k - first) * kGroup + j] = a_(k, begin + j);
    }
    const linalg::Product product{.a = &a_(0, first),
                                  .leading_a = size_,
                                  .b = turned_,
                                  .leading_b = kGroup,
                                  .depth = last - first,
                                  .columns = columns};
    const int whole = last + (size_ - last) / kLanes * kLanes;
    if (whole > last) {
      linalg::multiply(product, last, whole, &a_(last, begin), size_, linalg::Store::subtract);
    }
    if (whole == size_) return;
    linalg::multiply(product, whole, size_, apart_, kLanes, linalg::Store::assign);
    for (int j = 0; j < columns; ++j) {
      for (int i = whole; i < size_; ++i) a_(i, begin + j) -= apart_[kLanes * j + i - whole];
    }
  }

  // Updates columns begin .. end - 1 with one panel: computes its rows of U, and subtracts its
  // product from the rows below, up to row_end.
  void apply_panel(int first, int begin, int end, int row_end) {
    if (width(first) == kPanel) {
      solve_rows(first, begin, end);
    } else {
      solve_narrow_rows(first, begin, end);
    }
    const int last = first + width(first);
    int j = begin;
    for (; j + kTile <= end; j += kTile) update<kTile>(first, last, j, row_end);
    for (; j < end; ++j) update<1>(first, last, j, row_end);
  }

  template <int columns>
  void update(int first, int last, int column, int row_end) {
    if (last == row_end) return;
    const int rest = row_end - last;
    int k = first;
    for (; k + 4 <= last; k += 4) {
      subtract<columns, 4>(&a_(last, k), &a_(k, column), size_, &a_(last, column), rest);
    }
    for (; k < last; ++k) {
      subtract<columns, 1>(&a_(last, k), &a_(k, column), size_, &a_(last, column), rest);
    }
  }

  void solve_narrow_rows(int first, int begin, int end) {
    const int last = first + width(first);
    for (int j = begin; j < end; ++j) {
      for (int k = first; k < last; ++k) {
        add_scaled(&a_(k, j) + 1, -a_(k, j), &a_(k, k) + 1, last - k - 1);
      }
    }
  }

  // U_12 = L_11^-1 A_12 of a whole panel, several columns at a time to hide latency.
  void solve_rows(int first, int begin, int end) {
    using Column = Eigen::Matrix<double, kPanel, 1>;
    Eigen::Matrix<double, kPanel, kPanel> lower = a_.block<kPanel, kPanel>(first, first);
    lower.triangularView<Eigen::Upper>().setZero();
    int j = begin;
    for (; j + 4 <= end; j += 4) {
      Column u[4];
      for (int c = 0; c < 4; ++c) u[c] = a_.col(j + c).segment<kPanel>(first);
      for (int k = 0; k < kPanel; ++k) {
        for (Column& column : u) column += -column[k] * lower.col(k);
      }
      for (int c = 0; c < 4; ++c) a_.col(j + c).segment<kPanel>(first) = u[c];
    }
    for (; j < end; ++j) {
      Column u = a_.col(j).segment<kPanel>(first);
      for (int k = 0; k < kPanel; ++k) u += -u[k] * lower.col(k);
      a_.col(j).segment<kPanel>(first) = u;
    }
  }

  Eigen::Map<MatrixX> a_;
  std::span<int> pivot_;
  int size_, pivots_;
  alignas(64) double turned_[kGroup * kGroup];         // rows of U, transposed
  alignas(64) double apart_[kGroup * linalg::kLanes];  // product of the last, incomplete vector
};

}  // namespace

bool eliminate(const Eigen::Map<MatrixX>& a, std::span<int> pivot) {
  return LuElimination(a, pivot).run();
}

void DenseLu::reserve(int size) {
  if (pivot_.size() >= static_cast<std::size_t>(size)) return;
  const std::size_t room = std::max(static_cast<std::size_t>(size), 3 * pivot_.size() / 2);
  storage_.resize(room * room);
  pivot_.resize(room);
}

bool DenseLu::factorise(int size) {
  size_ = size;
  return eliminate(matrix(size), std::span(pivot_).first(static_cast<std::size_t>(size)));
}

void substitute(const Eigen::Ref<const MatrixX>& lu, std::span<const int> pivot,
                Eigen::Ref<VectorX> right) {
  const int size = static_cast<int>(pivot.size());
  for (int k = 0; k < size; ++k) {
    std::swap(right[k], right[pivot[static_cast<std::size_t>(k)]]);
  }
  for (int k = 0; k + 1 < size; ++k) {
    right.tail(size - k - 1) -= right[k] * lu.col(k).tail(size - k - 1);
  }
  for (int k = size; k-- > 0;) {
    right[k] /= lu(k, k);
    if (k > 0) right.head(k) -= right[k] * lu.col(k).head(k);
  }
}

void DenseLu::solve(Eigen::Ref<VectorX> right) const {
  substitute(Eigen::Map<const MatrixX>(storage_.data(), size_, size_),
             std::span(pivot_).first(static_cast<std::size_t>(size_)), right.head(size_));
}

}  // namespace sinew::qp
