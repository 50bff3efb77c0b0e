/// @file
/// A = P L D L^T P^T of a sparse symmetric indefinite matrix whose graph is long and thin, as that
/// of the optimality conditions of a motion in time: the frontal method (Irons 1970; Duff & Reid,
/// ACM Trans. Math. Software 9, 1983) along the levels of its graph, with pivots of one and two
/// rows by threshold.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::linalg {

/// Where an entry of a sparse matrix stands. Entries that stand in one place add up.
struct SparseEntry {
  int row = 0, column = 0;
};

/// Levels are the sets of unknowns at one distance from an end of the graph: each has neighbours in
/// the one before and the one after alone. Unknowns with so many neighbours that there would be no
/// levels come last. A front holds a level and what is left of those before; pivots are taken from
/// the level, those that are too small against their columns wait for the next front. The matrix is
/// scaled so that its largest entries by row are near one (Ruiz 2001).
class FrontalFactorisation {
 public:
  /// Makes the plan. @param size rows of A. @param entries places in either triangle, each pair of
  /// unknowns in one of the two.
  FrontalFactorisation(int size, std::vector<SparseEntry> entries);

  /// False where A is singular to rounding; the factorisation is then not to be used.
  /// @param values of the entries, in their order.
  bool factor(std::span<const double> values);
  /// Negative eigenvalues of A.
  int negative() const { return negative_; }
  /// x <- A^-1 x, by a workspace of its own: one thread at a time. @param x (size,).
  void solve(VectorX& x);
  /// result <- A x, by the entries. @param values as for factor(). @param x (size,).
  /// @param result (size,).
  void multiply(std::span<const double> values, const VectorX& x, VectorX& result) const;

  int levels() const { return static_cast<int>(level_begin_.size()) - 1; }

 private:
  /// What a front leaves behind.
  struct Front {
    std::size_t panel = 0;                ///< where its columns of L begin, its rows long each
    std::size_t rows = 0;                 ///< where its rows' unknowns begin
    int size = 0, pivots = 0, first = 0;  ///< rows; pivots, the first of which is so many overall
  };
  enum class Pivot { none, single, twin };

  void order();
  void plan_boundaries();
  void scale(std::span<const double> values);
  void assemble(std::size_t level, std::span<const double> values);
  void eliminate();
  void swap(int a, int b);
  /// Brings the next pivot to row and column `next`, and a twin's other half behind it.
  Pivot find(int next);
  void eliminate_single(int p);
  void eliminate_twin(int p);
  double* column(int j) { return front_.data() + static_cast<std::size_t>(j) * rows_.size(); }
  double& entry(int i, int j) { return i >= j ? column(j)[i] : column(i)[j]; }

  int size_;
  std::vector<SparseEntry> entries_;
  std::vector<int> level_order_, level_of_;  // unknowns level by level; of each its level
  std::vector<std::size_t> level_begin_;     // in level_order_
  std::vector<std::vector<int>> boundary_;   // of each level, without what waits
  std::vector<std::size_t> entry_begin_, entry_order_;  // entries by the level that takes them
  VectorX scale_, largest_;

  // The front at hand.
  std::vector<int> rows_, place_;  // its unknowns; of an unknown its row
  std::vector<double> front_, rest_, weighted_;
  std::vector<int> rest_rows_;
  int full_ = 0, done_ = 0;  // rows that may become pivots, that have

  std::vector<Front> fronts_;
  std::vector<double> panels_, diagonal_, beside_;  // D: beside_ is not 0 at the first of a twin
  std::vector<int> front_rows_;
  int negative_ = 0;
  VectorX local_;  // of solve()
};

}  // namespace sinew::linalg
