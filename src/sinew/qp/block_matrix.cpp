#include "sinew/qp/block_matrix.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/linalg/index.hpp"

namespace sinew::qp {

namespace {

using linalg::at;

}  // namespace

void BlockMatrix::assign(std::span<const BlockNode> nodes, const Eigen::Ref<const MatrixX>& a) {
  nodes_.assign(nodes.begin(), nodes.end());
  lower_row_.clear();
  lower_column_.clear();
  lower_values_.clear();
  for (int j = 0; j < this->nodes(); ++j) {
    const BlockNode& column = node(j);
    for (int i = j; i < this->nodes(); ++i) {
      const BlockNode& row = node(i);
      const auto block = a.block(row.row, column.row, row.size, column.size);
      bool some = i == j;
      for (int c = 0; c < column.size && !some; ++c) {
        for (int r = 0; r < row.size; ++r) some = some || block(r, c) != 0.0;
      }
      if (!some) continue;
      lower_row_.push_back(i);
      lower_column_.push_back(j);
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
          lower_values_.push_back(r < row.size && c < column.size ? block(r, c) : 0.0);
        }
      }
    }
  }
  mirror();
}

void BlockMatrix::assign(std::span<const BlockNode> nodes, const Eigen::SparseMatrix<double>& a) {
  nodes_.assign(nodes.begin(), nodes.end());
  lower_row_.clear();
  lower_column_.clear();
  lower_values_.clear();
  // place_: first the node of each row, then the entry of each node in the present column.
  const auto rows = static_cast<std::size_t>(a.rows());
  place_.assign(rows + nodes.size(), -1);
  for (int i = 0; i < this->nodes(); ++i) {
    for (int r = 0; r < node(i).size; ++r) place_[at(node(i).row + r)] = i;
  }
  for (int j = 0; j < this->nodes(); ++j) {
    const std::size_t first = lower_row_.size();
    const auto enter = [&](int i) {
      int& entry = place_[rows + at(i)];
      if (entry >= static_cast<int>(first)) return entry;
      entry = static_cast<int>(lower_row_.size());
      lower_row_.push_back(i);
      lower_column_.push_back(j);
      lower_values_.resize(lower_values_.size() + 9, 0.0);
      return entry;
    };
    enter(j);
    for (int c = 0; c < node(j).size; ++c) {
      for (Eigen::SparseMatrix<double>::InnerIterator it(a, node(j).row + c); it; ++it) {
        const int i = place_[at(static_cast<int>(it.row()))];
        if (i < j || it.value() == 0.0) continue;
        const int r = static_cast<int>(it.row()) - node(i).row;
        lower_values_[9 * at(enter(i)) + at(3 * c + r)] += it.value();
      }
    }
  }
  mirror();
}

// Sorts the lower triangle into columns, and adds the transposed blocks of the upper one.
void BlockMatrix::mirror() {
  const std::size_t count = nodes_.size(), lower = lower_row_.size();
  start_.assign(count + 1, 0);
  for (std::size_t e = 0; e < lower; ++e) {
    ++start_[at(lower_column_[e]) + 1];
    if (lower_row_[e] != lower_column_[e]) ++start_[at(lower_row_[e]) + 1];
  }
  for (std::size_t j = 0; j < count; ++j) start_[j + 1] += start_[j];
  row_.resize(at(start_.back()));
  values_.resize(9 * row_.size());
  diagonal_.resize(count);
  place_.assign(start_.begin(), start_.end() - 1);
  const auto put = [&](int i, int j, std::size_t from, bool transposed) {
    if (i == j) diagonal_[at(j)] = place_[at(j)];
    const auto to = at(place_[at(j)]++);
    row_[to] = i;
    const Eigen::Map<const Matrix3> block(&lower_values_[9 * from]);
    Eigen::Map<Matrix3> target(&values_[9 * to]);
    if (transposed) {
      target = block.transpose();
    } else {
      target = block;
    }
  };
  for (std::size_t e = 0; e < lower; ++e) {
    if (lower_row_[e] != lower_column_[e]) put(lower_column_[e], lower_row_[e], e, true);
  }
  for (std::size_t e = 0; e < lower; ++e) put(lower_row_[e], lower_column_[e], e, false);
}

void BlockMatrix::assign(const BlockMatrix& whole, std::span<const int> members,
                         std::span<const int> number) {
  nodes_.clear();
  start_.assign(1, 0);
  row_.clear();
  values_.clear();
  diagonal_.clear();
  int rows = 0;
  for (const int j : members) {
    nodes_.push_back({rows, whole.node(j).size});
    rows += whole.node(j).size;
    diagonal_.push_back(start_.back() + whole.diagonal_[at(j)] - whole.start_[at(j)]);
    for (int e = whole.start_[at(j)]; e < whole.start_[at(j) + 1]; ++e) {
      row_.push_back(number[at(whole.row_[at(e)])]);
    }
    const auto from = whole.values_.begin() + 9 * whole.start_[at(j)];
    values_.insert(values_.end(), from, from + 9 * (whole.start_[at(j) + 1] - whole.start_[at(j)]));
    start_.push_back(static_cast<int>(row_.size()));
  }
}

void BlockMatrix::gather(std::span<const int> members, std::span<const int> number,
                         std::span<const BlockNode> own, Eigen::Map<MatrixX> a) const {
  a.setZero();
  for (std::size_t k = 0; k < members.size(); ++k) {
    const auto j = at(members[k]);
    for (int e = start_[j]; e < start_[j + 1]; ++e) {
      const BlockNode& row = own[at(number[at(row_[at(e)])])];
      a.block(row.row, own[k].row, row.size, own[k].size) =
          block(e).topLeftCorner(row.size, own[k].size);
    }
  }
}

bool BlockMatrix::all_finite() const {
  double sum = 0.0;
  for (const double value : std::span(values_).first(9 * row_.size())) sum += value;
  return std::isfinite(sum);
}

void BlockMatrix::add_column(int j, const Vector3& by, Eigen::Ref<VectorX> y) const {
  for (int e = start_[at(j)]; e < start_[at(j) + 1]; ++e) {
    const BlockNode& to = node(row_[at(e)]);
    if (to.size == 3) {
      y.segment<3>(to.row).noalias() += block(e) * by;
    } else {
      y[to.row] += block(e).row(0).dot(by);
    }
  }
}

void BlockIslands::find(const BlockMatrix& matrix) {
  const int nodes = matrix.nodes();
  start_.assign(1, 0);
  order_.clear();
  number_.assign(at(nodes), -1);
  for (int first = 0; first < nodes; ++first) {
    if (number_[at(first)] >= 0) continue;
    number_[at(first)] = 0;
    order_.push_back(first);
    for (auto next = at(start_.back()); next < order_.size(); ++next) {
      const auto j = at(order_[next]);
      for (int e = matrix.starts()[j]; e < matrix.starts()[j + 1]; ++e) {
        const int i = matrix.rows()[at(e)];
        if (number_[at(i)] >= 0) continue;
        number_[at(i)] = 0;
        order_.push_back(i);
      }
    }
    std::sort(order_.begin() + start_.back(), order_.end());
    for (auto k = at(start_.back()); k < order_.size(); ++k) {
      number_[at(order_[k])] = static_cast<int>(k) - start_.back();
    }
    start_.push_back(static_cast<int>(order_.size()));
  }
}

}  // namespace sinew::qp
