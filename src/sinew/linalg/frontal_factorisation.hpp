/// @file
/// Factorisation A = P L D L^T P^T of a sparse symmetric indefinite matrix whose graph is long and
/// thin, such as the optimality conditions of a trajectory. It is the frontal method (Irons 1970;
/// Duff & Reid, ACM Trans. Math. Software 9, 1983) along the levels of the graph, with threshold
/// pivoting and 1x1 and 2x2 pivots.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::linalg {

/// Position of an entry of a sparse matrix. Entries at the same position are added.
struct SparseEntry {
  int row = 0, column = 0;
};

/// Frontal factorisation. A level is the set of unknowns at one distance from an end of the graph;
/// its neighbours are in the previous and the next level only. Unknowns with so many neighbours
/// that they would join the levels come last. A front contains a level and the remainder of the
/// previous fronts. Pivots are taken from the level; those that are too small compared with their
/// columns are delayed to the next front. The matrix is scaled so that the largest entry of each
/// row is near one (Ruiz 2001).
class FrontalFactorisation {
 public:
  /// Makes the plan. @param size rows of A. @param entries positions in either triangle, but for
  /// each pair of unknowns only in one.
  FrontalFactorisation(int size, std::vector<SparseEntry> entries);

  /// Factorises A. Returns false if A is singular to rounding; the factors must then not be used.
  /// @param values of the entries, in their order.
  bool factor(std::span<const double> values);
  /// Number of negative eigenvalues of A.
  int negative() const { return negative_; }
  /// Solves x <- A^-1 x. Uses a workspace of this object: not thread-safe. @param x (size,).
  void solve(VectorX& x);
  /// Multiplies result <- A x. @param values as for factor(). @param x (size,).
  /// @param result (size,).
  void multiply(std::span<const double> values, const VectorX& x, VectorX& result) const;

  int levels() const { return static_cast<int>(level_begin_.size()) - 1; }

 private:
  /// Factors of a front.
  struct Front {
    std::size_t panel = 0;                ///< start of its columns of L, of `size` rows each
    std::size_t rows = 0;                 ///< start of the unknowns of its rows
    int size = 0, pivots = 0, first = 0;  ///< number of rows; of pivots; number of the first pivot
  };
  enum class Pivot { none, single, twin };

  void order();
  void plan_boundaries();
  void scale(std::span<const double> values);
  void assemble(std::size_t level, std::span<const double> values);
  void eliminate();
  void swap(int a, int b);
  /// Swaps the next pivot to row and column `next`; a 2x2 pivot (twin) also uses the one after.
  Pivot find(int next);
  void eliminate_single(int p);
  void eliminate_twin(int p);
  double* column(int j) { return front_.data() + static_cast<std::size_t>(j) * rows_.size(); }
  double& entry(int i, int j) { return i >= j ? column(j)[i] : column(i)[j]; }

  int size_;
  std::vector<SparseEntry> entries_;
  std::vector<int> level_order_, level_of_;             // unknowns by level; level of each unknown
  std::vector<std::size_t> level_begin_;                // in level_order_
  std::vector<std::vector<int>> boundary_;              // of each level, without delayed pivots
  std::vector<std::size_t> entry_begin_, entry_order_;  // entries by the level that assembles them
  VectorX scale_, largest_;

  // The current front.
  std::vector<int> rows_, place_;  // its unknowns; row of each unknown
  std::vector<double> front_, rest_, weighted_;
  std::vector<int> rest_rows_;
  int full_ = 0, done_ = 0;  // number of rows that may become pivots, and that have

  std::vector<Front> fronts_;
  std::vector<double> panels_, diagonal_, beside_;  // L; D, beside_ is not 0 at the first of a twin
  std::vector<int> front_rows_;
  int negative_ = 0;
  VectorX local_;  // workspace of solve()
};

}  // namespace sinew::linalg
