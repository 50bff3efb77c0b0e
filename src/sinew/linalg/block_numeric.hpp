/// @file
/// Numeric data of a block factorisation, and operations on single panels. Each operation changes
/// one panel only, so that threads can work on different panels.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/linalg/aligned_buffer.hpp"
#include "sinew/linalg/block_symbolic.hpp"
#include "sinew/linalg/dense_kernels.hpp"
#include "sinew/linalg/factor_memory.hpp"

namespace sinew::linalg {

/// Input of a factorisation: the arrays of A, H and b (Factorisation::factorise()).
struct BlockInput {
  const double* matrix;
  const double* border;
  const double* right;
};

/// L, S and the border sums for one BlockSymbolic.
class BlockNumeric {
 public:
  /// Working memory of one thread.
  struct Scratch {
    AlignedBuffer product;  ///< product of an update, before it is spread over the target rows
    AlignedBuffer signed_rows;
    AlignedBuffer values;           ///< rows of a panel in a substitution
    std::vector<int> column_place;  ///< target column of each node of an update
  };

  /// @param symbolic must outlive this. @param memory for factors of factor_size(symbolic) doubles.
  /// @param threads number of threads that factorise.
  BlockNumeric(const BlockSymbolic& symbolic, std::shared_ptr<FactorMemory> memory, int threads);
  /// Size of the factor in doubles.
  static std::size_t factor_size(const BlockSymbolic& symbolic);

  /// Takes memory for the factor, unless it has some. Call it before the first panel.
  void begin();
  /// Returns the memory of the factor.
  void release();
  bool holds_factor() const { return factor_.size() > 0; }

  /// Fills a panel with the entries of A, H and b.
  void assemble(int panel, const BlockInput& input);
  /// Subtracts the updates of all descendants from panel rows row_begin .. row_end-1.
  void update(int panel, int row_begin, int row_end, Scratch& scratch);
  /// Factorises the diagonal block and, unless the panel is split, the rows below.
  void factorise(int panel, Scratch& scratch);
  /// Solves for rows row_begin .. row_end-1 of a split panel whose diagonal block is factorised.
  void solve_rows(int panel, int row_begin, int row_end, Scratch& scratch);
  /// Sums the border updates of group `group`.
  void update_border(int group, Scratch& scratch);
  /// Adds the groups; the result is the lower triangle of -(H; b) A^-1 (H; b)^T, see border().
  void finish_border();

  /// Forward substitution x := S^-1 L^-1 x, in elimination order.
  void forward(double* x, Scratch& scratch) const;
  /// Replaces the row of b in the factor, b^T L^-T S^-1, and multiplies the border with it.
  /// @param x (3 nodes,) S^-1 L^-1 b, in elimination order, see forward().
  /// @param products (3 border nodes,) (H; b) A^-1 b.
  void renew_right(const double* x, double* products);
  /// Backward substitution x := L^-T (x + L_border^T weights), in elimination order. weights (3
  /// border nodes,).
  void backward(double* x, const double* weights, Scratch& scratch) const;

  /// Values of a factorised panel, S of its columns, whether all of these are positive, and its
  /// diagonal block for substitutions.
  const double* values(const Panel& panel) const { return factor_.data() + panel.offset; }
  const double* sign(const Panel& panel) const { return sign_.data() + 3 * panel.first; }
  bool positive(int panel) const { return negatives_[static_cast<std::size_t>(panel)] == 0; }
  DiagonalBlock diagonal_block(int panel, Scratch& scratch);

  const BlockSymbolic& symbolic() const { return *symbolic_; }
  Scratch& scratch(int thread) { return scratch_[static_cast<std::size_t>(thread)]; }
  /// Entry (i, j), i >= j, of the border panel.
  double border(int i, int j) const;
  int negative_pivots() const;
  bool singular() const;
  std::size_t bytes() const;

 private:
  void apply(const Update& update, const Panel& target, double* panel, int row_begin, int row_end,
             Scratch& scratch) const;
  const BlockSymbolic* symbolic_;
  std::shared_ptr<FactorMemory> memory_;
  AlignedBuffer factor_;   ///< empty after release()
  AlignedBuffer inverse_;  ///< 1 / L_jj; before a panel is factorised, the magnitude of A_jj
  AlignedBuffer sign_;
  AlignedBuffer border_sums_;
  std::vector<int> negatives_;           ///< by panel
  std::vector<unsigned char> singular_;  ///< by panel
  std::vector<Scratch> scratch_;
};

}  // namespace sinew::linalg
