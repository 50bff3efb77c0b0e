#include "sinew/qp/block_lu.hpp"

#include <algorithm>

#include "sinew/linalg/index.hpp"
#include "sinew/linalg/supernodes.hpp"
#include "sinew/qp/dense_lu.hpp"

namespace sinew::qp {

namespace {

// Small fronts cost more than the stored zeros of merged ones.
constexpr linalg::SupernodeSettings kSupernodes{.zero_blocks = 24, .zero_fraction = 0.0};

using linalg::at;

linalg::SupernodePartition supernodes(const BlockMatrix& pattern) {
  linalg::BlockPattern lower;
  lower.nodes = pattern.nodes();
  for (int j = 0; j < pattern.nodes(); ++j) {
    lower.row.push_back(j);
    for (int e = pattern.starts()[at(j)]; e < pattern.starts()[at(j) + 1]; ++e) {
      if (pattern.rows()[at(e)] > j) lower.row.push_back(pattern.rows()[at(e)]);
    }
    lower.column_start.push_back(lower.blocks());
  }
  const linalg::NodeGraph graph(lower);
  const auto order = linalg::fill_reducing_order(graph, linalg::Ordering::amd);
  const std::vector<std::vector<std::int32_t>> no_border(at(pattern.nodes()));
  return {linalg::Elimination(graph, order, no_border), kSupernodes};
}

}  // namespace

bool BlockLu::planned_for(const BlockMatrix& pattern) const {
  const auto same_size = [](const BlockNode& a, const BlockNode& b) {
    return a.row == b.row && a.size == b.size;
  };
  return std::ranges::equal(nodes_, pattern.all_nodes(), same_size) &&
         std::ranges::equal(start_, pattern.starts()) &&
         std::ranges::equal(pattern_row_, pattern.rows());
}

void BlockLu::analyse(const BlockMatrix& pattern) {
  if (planned_for(pattern)) return;
  nodes_.assign(pattern.all_nodes().begin(), pattern.all_nodes().end());
  start_.assign(pattern.starts().begin(), pattern.starts().end());
  pattern_row_.assign(pattern.rows().begin(), pattern.rows().end());
  values_.resize(9 * pattern_row_.size());
  make_fronts(pattern);
}

void BlockLu::make_fronts(const BlockMatrix& pattern) {
  const linalg::SupernodePartition parts = supernodes(pattern);
  fronts_.assign(at(parts.count()), {});
  row_.clear();
  std::vector<int> position(nodes_.size()), front_of(nodes_.size());
  std::size_t storage = 0, pivots = 0;
  int largest = 0;
  flops_ = 0.0;
  for (int s = 0; s < parts.count(); ++s) {
    Front& front = fronts_[at(s)];
    front.row = row_.size();
    const auto add = [&](int k) {
      const BlockNode& node = pattern.node(parts.order[at(k)]);
      for (int r = 0; r < node.size; ++r) row_.push_back(node.row + r);
    };
    for (int k = parts.start[at(s)]; k < parts.start[at(s) + 1]; ++k) {
      position[at(parts.order[at(k)])] = k;
      front_of[at(parts.order[at(k)])] = s;
      add(k);
    }
    front.own = static_cast<int>(row_.size() - front.row);
    for (const int k : parts.rows[at(s)]) add(k);
    front.size = static_cast<int>(row_.size() - front.row);
    front.storage = storage;
    front.pivot = pivots;
    storage += at(front.size) * at(front.size);
    pivots += at(front.own);
    largest = std::max(largest, front.size);
    for (int k = 0; k < front.own; ++k) {
      const double rest = front.size - k - 1;
      flops_ += 2.0 * rest * rest;
    }
  }
  linalg::grow(storage_, storage);
  pivot_.resize(pivots);
  part_.resize(largest);
  place_blocks(pattern, position, front_of);
  std::vector<int> front_of_row(row_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    for (int r = 0; r < nodes_[i].size; ++r) front_of_row[at(nodes_[i].row + r)] = front_of[i];
  }
  find_parents(front_of_row);
}

// A block belongs to the front that eliminates the first of its two nodes.
void BlockLu::place_blocks(const BlockMatrix& pattern, std::span<const int> position,
                           std::span<const int> front_of) {
  std::vector<std::vector<BlockScatter>> of_front(fronts_.size());
  for (int j = 0; j < pattern.nodes(); ++j) {
    for (int e = start_[at(j)]; e < start_[at(j) + 1]; ++e) {
      const int i = pattern_row_[at(e)];
      const int first = position[at(i)] < position[at(j)] ? i : j;
      of_front[at(front_of[at(first)])].push_back(
          {e, i, j, pattern.node(i).size, pattern.node(j).size});
    }
  }
  scatters_.clear();
  std::vector<int> place(nodes_.empty() ? 0 : row_.size());
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    for (int k = 0; k < front.size; ++k) place[at(row_[front.row + at(k)])] = k;
    front.block_begin = scatters_.size();
    for (BlockScatter& p : of_front[f]) {
      p.row = place[at(pattern.node(p.row).row)];
      p.column = place[at(pattern.node(p.column).row)];
      scatters_.push_back(p);
    }
    front.block_end = scatters_.size();
  }
}

void BlockLu::find_parents(std::span<const int> front_of_row) {
  in_parent_.clear();
  children_begin_.assign(fronts_.size() + 1, 0);
  for (Front& front : fronts_) {
    front.in_parent = in_parent_.size();
    if (front.own == front.size) continue;
    front.parent = front_of_row[at(row_[front.row + at(front.own)])];
    ++children_begin_[at(front.parent) + 1];
    const Front& parent = fronts_[at(front.parent)];
    const auto begin = row_.begin() + static_cast<std::ptrdiff_t>(parent.row);
    for (int k = front.own, from = 0; k < front.size; ++k) {
      while (begin[from] != row_[front.row + at(k)]) ++from;  // both in the order of elimination
      in_parent_.push_back(from);
    }
  }
  for (std::size_t f = 0; f < fronts_.size(); ++f) children_begin_[f + 1] += children_begin_[f];
  children_.resize(at(children_begin_.back()));
  std::vector<int> next(children_begin_.begin(), children_begin_.end() - 1);
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    if (fronts_[f].parent >= 0) {
      children_[at(next[at(fronts_[f].parent)]++)] = static_cast<int>(f);
    }
  }
}

void BlockLu::assemble(const Front& front) {
  auto a = matrix(front);
  a.setZero();
  for (std::size_t k = front.block_begin; k < front.block_end; ++k) {
    const BlockScatter& p = scatters_[k];
    const double* from = block(p.entry);
    for (int c = 0; c < p.columns; ++c) {
      for (int r = 0; r < p.rows; ++r) a(p.row + r, p.column + c) = from[3 * c + r];
    }
  }
  const auto number = static_cast<std::size_t>(&front - fronts_.data());
  for (int c = children_begin_[number]; c < children_begin_[number + 1]; ++c) {
    const Front& child = fronts_[at(children_[at(c)])];
    const auto rest =
        matrix(child).bottomRightCorner(child.size - child.own, child.size - child.own);
    const int* place = &in_parent_[child.in_parent];
    for (Eigen::Index j = 0; j < rest.cols(); ++j) {
      double* column = &a(0, place[j]);
      const double* from = &rest(0, j);
      for (Eigen::Index i = 0; i < rest.rows(); ++i) column[place[i]] += from[i];
    }
  }
}

bool BlockLu::factorise() {
  for (const Front& front : fronts_) {
    assemble(front);
    if (!eliminate(matrix(front), std::span(pivot_).subspan(front.pivot, at(front.own)))) {
      return false;
    }
  }
  return true;
}

void BlockLu::solve(Eigen::Ref<VectorX> right) {
  for (const Front& front : fronts_) {
    const auto a = matrix(front);
    const int* row = &row_[front.row];
    auto x = part_.head(front.size);
    for (int k = 0; k < front.size; ++k) x[k] = right[row[k]];
    for (int k = 0; k < front.own; ++k) std::swap(x[k], x[pivot_[front.pivot + at(k)]]);
    for (int k = 0; k < front.own; ++k) {
      const Eigen::Index below = front.size - k - 1;
      x.tail(below) -= x[k] * a.col(k).tail(below);
    }
    for (int k = 0; k < front.size; ++k) right[row[k]] = x[k];
  }
  for (std::size_t f = fronts_.size(); f-- > 0;) {
    const Front& front = fronts_[f];
    const auto a = matrix(front);
    const int* row = &row_[front.row];
    auto x = part_.head(front.size);
    for (int k = 0; k < front.size; ++k) x[k] = right[row[k]];
    for (int k = front.size; k-- > front.own;) {
      x.head(front.own) -= x[k] * a.col(k).head(front.own);
    }
    for (int k = front.own; k-- > 0;) {
      x[k] /= a(k, k);
      x.head(k) -= x[k] * a.col(k).head(k);
    }
    for (int k = 0; k < front.own; ++k) right[row[k]] = x[k];
  }
}

}  // namespace sinew::qp
