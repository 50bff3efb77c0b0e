/// @file
/// Which rows of the model the problem of a step has.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::sim {

/// The problem's rows are those of the model, in their order, without those of points that are left
/// out of the step, and one for each group of rows (mechanics::RowGroups). Contacts stand behind
/// all others, whose numbers are therefore the same in both.
class RowNumbering {
 public:
  /// @param rows active ones and groups; these are remembered, the rest is not.
  void number(const mechanics::RowValues& rows);

  /// The model's row that a row of the problem is; of a group the first.
  int model_row_of(int row) const { return model_rows_[static_cast<std::size_t>(row)]; }
  /// Where a row of the model is in the problem; -1: nowhere.
  int problem_row_of(int row) const { return problem_rows_[static_cast<std::size_t>(row)]; }
  /// (rows,) of each.
  std::span<const int> problem_rows() const { return problem_rows_; }

  /// Of all rows' motions, those of the problem: of groups the mean.
  void gather_motions(const VectorX& all, VectorX& result) const;
  /// Of all rows' efforts, those of the problem: of groups the sum.
  void gather_efforts(std::span<const double> all, linalg::AlignedNumbers& result) const;
  /// And back; rows that are left out get zero.
  void scatter_efforts(const linalg::AlignedNumbers& numbers, std::span<double> all) const;
  /// Writes what an effort of one row of the problem is on the model's.
  void spread(int row, double effort, std::span<double> all) const;

 private:
  struct Member {
    int row = 0, problem_row = 0;
    double share = 1.0;
  };
  std::vector<int> problem_rows_;  // (rows,) in the problem, -1: left out
  std::vector<int> model_rows_;    // (rows of the problem,) of the model
  std::vector<Member> members_;    // of groups
};

}  // namespace sinew::sim
