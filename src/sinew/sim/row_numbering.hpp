/// @file
/// Which rows of the model the problem of a step has.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"

namespace sinew::sim {

/// The problem's rows are those of the model, in their order, without those of points that are left
/// out of the step. Contacts stand behind all others, whose numbers are therefore the same in both.
class RowNumbering {
 public:
  /// @param active (rows,) see mechanics::RowValues.
  void number(std::span<const char> active);

  /// The model's row that a row of the problem is.
  int model_row_of(int row) const { return model_rows_[static_cast<std::size_t>(row)]; }
  /// Where a row of the model is in the problem; -1: nowhere.
  int problem_row_of(int row) const { return problem_rows_[static_cast<std::size_t>(row)]; }
  /// (rows,) of each.
  std::span<const int> problem_rows() const { return problem_rows_; }

  /// Of numbers of all rows, those of the problem.
  void gather(const VectorX& all, VectorX& result) const;
  void gather(std::span<const double> all, linalg::AlignedNumbers& result) const;
  /// And back; rows that are left out get zero.
  void scatter(const linalg::AlignedNumbers& numbers, std::span<double> all) const;

 private:
  std::vector<int> problem_rows_;  // (rows,) in the problem, -1: left out
  std::vector<int> model_rows_;    // (rows of the problem,) of the model
};

}  // namespace sinew::sim
