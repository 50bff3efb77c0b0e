/// @file
/// Splits a cone problem into its connected parts and solves them one by one. Two blocks belong to
/// one part if entries of the matrix couple them, directly or through other blocks.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/block_lu.hpp"
#include "sinew/qp/block_matrix.hpp"
#include "sinew/qp/cone_island.hpp"
#include "sinew/qp/sparse_cone_problem.hpp"

namespace sinew::qp {

/// Splits, solves and collects the parts of a cone problem.
class ConeParts {
 public:
  explicit ConeParts(const ConeSettings& settings)
      : measure_(settings.measure), island_(settings) {}

  /// Solves the problem as a whole, with the given dense matrix.
  const ConeResult& solve_whole(const ConeProblem& problem, std::span<double> x);
  /// Solve the problem part by part.
  const ConeResult& solve(const ConeProblem& problem, std::span<double> x);
  const ConeResult& solve(const SparseConeProblem& problem, std::span<double> x);
  const ConeResult& result() const { return whole_result_ ? island_.result() : result_; }

 private:
  /// A sparse part: its matrix and symbolic factorisation, kept for the next problem.
  struct Sparse {
    BlockMatrix matrix;
    BlockLu lu;
  };

  template <class Problem>
  const ConeResult& solve_split(const Problem& problem, std::span<double> x);
  template <class Problem>
  void take_blocks(const Problem& problem);
  template <class Problem>
  void free_motion(const Problem& problem, std::span<const double> x);
  template <class Problem>
  ConeStatus measure(const Problem& problem, auto&& own_block);
  template <class Problem>
  void solve_part(const Problem& problem, std::span<double> x, std::span<const int> members);
  template <class Problem>
  void take_out(const Problem& problem, std::span<const double> x, std::span<const int> members);
  void put_back(std::span<double> x, std::span<const int> members);
  void start_result(std::size_t cones);
  void add_result(std::span<const int> members, ConeStatus status);
  void finish_result();

  ConeMeasure measure_;
  ConeIsland island_;
  ConeResult result_;          // of all parts
  bool whole_result_ = false;  // solved as a whole: the result is that of island_
  ConeMiss miss_;              // of all parts
  ConeScales scales_;
  std::vector<double> box_scale_, scale_;
  std::vector<BlockNode> nodes_;  // boxes, then cones
  std::vector<char> in_block_;    // (rows,)
  VectorX free_;                  // offset plus the motion due to the x of rows in no block
  BlockMatrix whole_;
  BlockIslands islands_;

  // The present part.
  std::vector<BlockNode> part_nodes_;
  std::vector<BoxBlock> part_boxes_;
  std::vector<ConeBlock> part_cones_;
  std::vector<double> part_box_scale_, part_scale_;
  linalg::ScratchMatrix part_matrix_, part_offset_;
  linalg::AlignedNumbers part_x_;
  std::vector<std::unique_ptr<Sparse>> sparse_;
  std::size_t sparse_count_ = 0;
};

}  // namespace sinew::qp
