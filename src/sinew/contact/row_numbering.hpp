/// @file
/// Mapping between the rows of the model and those of a step's problem.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::contact {

/// The rows of the problem are those of the model in the same order, without the rows of inactive
/// contact points, and with one row for each group of rows (mechanics::RowGroups). Contacts come
/// after all other rows, whose numbers are therefore the same in both.
class RowNumbering {
 public:
  /// @param rows whose active rows and groups are stored; no other data of them is used.
  void number(const mechanics::RowValues& rows);

  /// The model's row for a row of the problem; for a group, the first one.
  int model_row_of(int row) const { return model_rows_[static_cast<std::size_t>(row)]; }
  /// The problem's row for a row of the model; -1: none.
  int problem_row_of(int row) const { return problem_rows_[static_cast<std::size_t>(row)]; }
  /// (rows,) the same for all rows of the model.
  std::span<const int> problem_rows() const { return problem_rows_; }

  /// Gathers the motions of the problem's rows; a group gets the mean, weighted by shares.
  void gather_motions(const VectorX& all, VectorX& result) const;
  /// Gathers the efforts of the problem's rows; a group gets the sum.
  void gather_efforts(std::span<const double> all, linalg::AlignedNumbers& result) const;
  /// The inverse; inactive rows get zero.
  void scatter_efforts(const linalg::AlignedNumbers& numbers, std::span<double> all) const;
  /// Writes the effort of one row of the problem to the corresponding rows of the model.
  void spread(int row, double effort, std::span<double> all) const;

 private:
  struct Member {
    int row = 0, problem_row = 0;
    double share = 1.0;
  };
  std::vector<int> problem_rows_;  // (rows,) row of the problem, -1: inactive
  std::vector<int> model_rows_;    // (rows of the problem,) row of the model
  std::vector<Member> members_;    // rows of groups
};

}  // namespace sinew::contact
