#include "sinew/qp/cone_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/linalg/index.hpp"

namespace sinew::qp {

namespace {

// A block whose diagonal is below this part of the largest cannot move.
constexpr double kFixed = 1e-14;
// Parts with more rows than this and less than this part of their blocks are kept sparse.
constexpr int kDenseRows = 96;
constexpr double kSparse = 0.4;

using linalg::at;

void add_column(const ConeProblem& problem, int j, double by, VectorX& motion) {
  motion += by * problem.matrix.col(j);
}
void add_column(const SparseConeProblem& problem, int j, double by, VectorX& motion) {
  for (Eigen::SparseMatrix<double>::InnerIterator it(problem.matrix, j); it; ++it) {
    motion[it.row()] += by * it.value();
  }
}

}  // namespace

const ConeResult& ConeParts::solve_whole(const ConeProblem& problem, std::span<double> x) {
  const auto& w = problem.matrix;
  start_result(problem.cones.size());
  double sum = 0.0;
  for (const ConeBlock& cone : problem.cones) sum += w.middleCols<3>(cone.row).sum();
  for (const BoxBlock& box : problem.boxes) sum += w.col(box.row).sum();
  const int boxes = static_cast<int>(problem.boxes.size());
  result_.status = measure(problem, [&](int i) -> Matrix3 {
    if (i >= boxes)
      return w.block<3, 3>(problem.cones[at(i - boxes)].row, problem.cones[at(i - boxes)].row);
    const int row = problem.boxes[at(i)].row;
    return w(row, row) * Matrix3::Identity();
  });
  if (!std::isfinite(sum)) result_.status = ConeStatus::not_finite;
  if (result_.status != ConeStatus::solved) return result_;
  island_.solve({problem, nullptr, nullptr, box_scale_, scale_, scales_}, x);
  whole_result_ = true;
  return island_.result();
}

const ConeResult& ConeParts::solve(const ConeProblem& problem, std::span<double> x) {
  return solve_split(problem, x);
}

const ConeResult& ConeParts::solve(const SparseConeProblem& problem, std::span<double> x) {
  return solve_split(problem, x);
}

template <class Problem>
const ConeResult& ConeParts::solve_split(const Problem& problem, std::span<double> x) {
  start_result(problem.cones.size());
  take_blocks(problem);
  whole_.assign(nodes_, problem.matrix);
  result_.status = measure(problem, [&](int i) -> Matrix3 { return whole_.diagonal(i); });
  if (!whole_.all_finite()) result_.status = ConeStatus::not_finite;
  if (result_.status != ConeStatus::solved) return result_;
  free_motion(problem, x);
  islands_.find(whole_);
  for (int i = 0; i < islands_.count(); ++i) solve_part(problem, x, islands_.members(i));
  finish_result();
  return result_;
}

template <class Problem>
void ConeParts::take_blocks(const Problem& problem) {
  nodes_.clear();
  for (const BoxBlock& box : problem.boxes) nodes_.push_back({box.row, 1});
  for (const ConeBlock& cone : problem.cones) nodes_.push_back({cone.row, 3});
}

template <class Problem>
void ConeParts::free_motion(const Problem& problem, std::span<const double> x) {
  free_ = problem.offset;
  if (scales_.rows == static_cast<int>(x.size())) return;
  in_block_.assign(x.size(), 0);
  for (const BlockNode& node : nodes_) std::fill_n(in_block_.begin() + node.row, node.size, 1);
  for (std::size_t j = 0; j < x.size(); ++j) {
    if (in_block_[j] == 0 && x[j] != 0.0) add_column(problem, static_cast<int>(j), x[j], free_);
  }
}

// Computes the scales of the blocks and of the whole problem. @param own_block diagonal block of a
// box or a cone, by its number.
template <class Problem>
ConeStatus ConeParts::measure(const Problem& problem, auto&& own_block) {
  const int boxes = static_cast<int>(problem.boxes.size());
  box_scale_.resize(problem.boxes.size());
  scale_.resize(problem.cones.size());
  double sum = 0.0, squares = 0.0, largest = 0.0;
  scales_ = {};
  for (std::size_t k = 0; k < scale_.size(); ++k) {
    const Vector3 offset = problem.offset.template segment<3>(problem.cones[k].row);
    scale_[k] = own_block(boxes + static_cast<int>(k)).trace() / 3.0;
    largest = std::max(largest, scale_[k]);
    sum += scale_[k] + offset.sum();
    squares += offset.squaredNorm();
    scales_.largest_offset = std::max(scales_.largest_offset, offset.cwiseAbs().maxCoeff());
  }
  for (std::size_t k = 0; k < box_scale_.size(); ++k) {
    const BoxBlock& box = problem.boxes[k];
    box_scale_[k] = own_block(static_cast<int>(k))(0, 0);
    const double beyond = problem.offset[box.row] - box.target;
    sum += box_scale_[k] + problem.offset[box.row];
    squares += beyond * beyond;
  }
  scales_.natural_unit = std::sqrt(squares);
  scales_.rows = boxes + 3 * static_cast<int>(scale_.size());
  if (!std::isfinite(sum)) return ConeStatus::not_finite;
  for (const double scale : box_scale_) {
    if (scale < 0.0) return ConeStatus::not_convex;
  }
  for (double& scale : scale_) {
    if (scale < -kFixed * largest) return ConeStatus::not_convex;
    if (!(scale > kFixed * largest)) scale = 0.0;
  }
  return ConeStatus::solved;
}

template <class Problem>
void ConeParts::solve_part(const Problem& problem, std::span<double> x,
                           std::span<const int> members) {
  take_out(problem, x, members);
  const auto rows = static_cast<Eigen::Index>(part_offset_.view().rows());
  double blocks = 0.0;
  for (const int j : members) blocks += whole_.starts()[at(j) + 1] - whole_.starts()[at(j)];
  const auto count = static_cast<double>(members.size());
  const bool sparse = rows > kDenseRows && blocks < kSparse * count * count;
  auto matrix = part_matrix_.shape(sparse ? 0 : rows, sparse ? 0 : rows);
  ConePart part{{matrix, std::as_const(part_offset_).view().col(0), part_boxes_, part_cones_},
                nullptr,
                nullptr,
                part_box_scale_,
                part_scale_,
                scales_};
  if (sparse) {
    if (sparse_count_ == sparse_.size()) sparse_.push_back(std::make_unique<Sparse>());
    Sparse& own = *sparse_[sparse_count_++];
    own.matrix.assign(whole_, members, islands_.numbers());
    own.lu.analyse(own.matrix);
    part.blocks = &own.matrix;
    part.lu = &own.lu;
  } else {
    whole_.gather(members, islands_.numbers(), part_nodes_, matrix);
  }
  const ConeStatus status = island_.solve(part, {part_x_.data(), static_cast<std::size_t>(rows)});
  put_back(x, members);
  add_result(members, status);
}

template <class Problem>
void ConeParts::take_out(const Problem& problem, std::span<const double> x,
                         std::span<const int> members) {
  part_nodes_.clear();
  part_boxes_.clear();
  part_cones_.clear();
  part_box_scale_.clear();
  part_scale_.clear();
  int rows = 0;
  for (const int j : members) {
    part_nodes_.push_back({rows, nodes_[at(j)].size});
    rows += nodes_[at(j)].size;
    const std::size_t boxes = problem.boxes.size();
    if (at(j) < boxes) {
      part_boxes_.push_back(problem.boxes[at(j)]);
      part_boxes_.back().row = part_nodes_.back().row;
      part_box_scale_.push_back(box_scale_[at(j)]);
    } else {
      part_cones_.push_back({part_nodes_.back().row, problem.cones[at(j) - boxes].friction});
      part_scale_.push_back(scale_[at(j) - boxes]);
    }
  }
  auto offset = part_offset_.shape(rows, 1);
  linalg::grow(part_x_, at(rows));
  for (std::size_t k = 0; k < members.size(); ++k) {
    const BlockNode& from = nodes_[at(members[k])];
    offset.col(0).segment(part_nodes_[k].row, from.size) = free_.segment(from.row, from.size);
    std::copy_n(x.begin() + from.row, from.size, part_x_.begin() + part_nodes_[k].row);
  }
}

void ConeParts::put_back(std::span<double> x, std::span<const int> members) {
  for (std::size_t k = 0; k < members.size(); ++k) {
    const BlockNode& to = nodes_[at(members[k])];
    std::copy_n(part_x_.begin() + part_nodes_[k].row, to.size, x.begin() + to.row);
  }
}

void ConeParts::start_result(std::size_t cones) {
  sparse_count_ = 0;
  whole_result_ = false;
  miss_ = {};
  result_.sweeps = result_.newton_steps = 0;
  result_.residual = result_.signorini = result_.coulomb = result_.complementarity = 0.0;
  result_.states.assign(cones, ContactState::open);
}

void ConeParts::add_result(std::span<const int> members, ConeStatus status) {
  const ConeResult& own = island_.result();
  if (status != ConeStatus::solved) result_.status = status;
  result_.sweeps = std::max(result_.sweeps, own.sweeps);
  result_.newton_steps = std::max(result_.newton_steps, own.newton_steps);
  result_.signorini = std::max(result_.signorini, own.signorini);
  result_.coulomb = std::max(result_.coulomb, own.coulomb);
  result_.complementarity = std::max(result_.complementarity, own.complementarity);
  miss_.distance = std::max(miss_.distance, island_.miss().distance);
  miss_.effort = std::max(miss_.effort, island_.miss().effort);
  miss_.natural += island_.miss().natural;
  const std::size_t boxes = part_boxes_.size(), all_boxes = box_scale_.size();
  for (std::size_t k = boxes; k < members.size(); ++k) {
    result_.states[at(members[k]) - all_boxes] = own.states[k - boxes];
  }
}

void ConeParts::finish_result() {
  result_.residual = measure_ == ConeMeasure::natural_map
                         ? std::sqrt(miss_.natural) / std::max(scales_.natural_unit, 1e-300)
                         : miss_.distance / std::max(miss_.effort, 1e-300);
}

}  // namespace sinew::qp
