#include "sinew/qp/force_parts.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/linalg/index.hpp"

namespace sinew::qp {

namespace {

using linalg::at;

bool couples(const ConeProblem& problem, BlockRows one, BlockRows other) {
  for (int j = one.row; j < one.row + one.count; ++j) {
    for (int i = other.row; i < other.row + other.count; ++i) {
      if (problem.matrix(i, j) != 0.0) return true;
    }
  }
  return false;
}

}  // namespace

BlockRows rows_of(const ConeProblem& problem, int block) {
  const auto boxes = problem.boxes.size();
  if (at(block) < boxes) return {problem.boxes[at(block)].row, 1};
  const ConeBlock& cone = problem.cones[at(block) - boxes];
  return {cone.row, cone.friction > 0.0 ? 3 : 1};
}

void ForceRows::clear() {
  sets.clear();
  rows.clear();
}

void ForceRows::add(EffortSet set, int row) {
  set.row = static_cast<int>(rows.size());
  sets.push_back(set);
  for (int c = 0; c < set.size(); ++c) rows.push_back(row + c);
}

void ForceRows::gather(const ConeProblem& problem, const ForceScales& scales) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  auto to = matrix.shape(count, count);
  own.resize(rows.size());
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const double unit = scales.unit[at(rows[j])];
    const auto from = problem.matrix.col(rows[j]);
    auto column = to.col(static_cast<Eigen::Index>(j));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      column[static_cast<Eigen::Index>(i)] = unit * scales.unit[at(rows[i])] * from[rows[i]];
    }
    own[j] = std::max(unit * unit * scales.alone[at(rows[j])], to(at(j), at(j)));
  }
}

int ForceParts::root(int node) {
  while (parent_[at(node)] != node) node = parent_[at(node)] = parent_[at(parent_[at(node)])];
  return node;
}

// The smallest node of a part is its root.
void ForceParts::unite(const ConeProblem& problem, const ForceScales& scales) {
  const auto boxes = static_cast<int>(problem.boxes.size());
  nodes_.clear();
  for (int b = 0; b < boxes; ++b) {
    const BoxBlock& box = problem.boxes[at(b)];
    if (box.lower < box.upper && problem.matrix(box.row, box.row) > 0.0) nodes_.push_back(b);
  }
  for (int c = 0; c < static_cast<int>(problem.cones.size()); ++c) {
    if (scales.rigid[at(c)] != 0) nodes_.push_back(boxes + c);
  }
  parent_.resize(nodes_.size());
  for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
    parent_[at(i)] = i;
    for (int j = 0; j < i; ++j) {
      const int own = root(i), other = root(j);
      if (own == other) continue;
      if (!couples(problem, rows_of(problem, nodes_[at(i)]), rows_of(problem, nodes_[at(j)]))) {
        continue;
      }
      parent_[at(std::max(own, other))] = std::min(own, other);
    }
  }
}

bool ForceParts::is_mixed(const ConeProblem& problem, const ForceScales& scales,
                          const ForcePart& part) const {
  for (std::size_t c = 0; c < problem.cones.size(); ++c) {
    if (scales.rigid[c] != 0) continue;
    const BlockRows soft{problem.cones[c].row, 3};
    for (const int block : blocks(part)) {
      if (couples(problem, soft, rows_of(problem, block))) return true;
    }
  }
  return false;
}

void ForceParts::find(const ConeProblem& problem, const ForceScales& scales, LeastForces& solver,
                      ForceRows& rows) {
  parts_.clear();
  blocks_.clear();
  unite(problem, scales);
  for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
    if (parent_[at(i)] != i) continue;
    ForcePart part{.first = static_cast<int>(blocks_.size())};
    rows.clear();
    for (int j = i; j < static_cast<int>(nodes_.size()); ++j) {
      if (root(j) != i) continue;
      const BlockRows own = rows_of(problem, nodes_[at(j)]);
      blocks_.push_back(nodes_[at(j)]);
      for (int c = 0; c < own.count; ++c) rows.add({}, own.row + c);
    }
    part.count = static_cast<int>(blocks_.size()) - part.first;
    part.rows = static_cast<int>(rows.rows.size());
    bool keeps = part.count > 1 && part.rows <= kMaxRows;
    if (keeps) {
      rows.gather(problem, scales);
      keeps = solver.factorise(rows.matrix.view(), rows.own) && solver.rank() < part.rows;
    }
    if (!keeps) {
      blocks_.resize(at(part.first));
      continue;
    }
    const auto rank = static_cast<double>(solver.rank());
    part.large = part.rows * rank * rank > kMaxWork;
    part.mixed = is_mixed(problem, scales, part);
    parts_.push_back(part);
  }
}

}  // namespace sinew::qp
