/// @file
/// The numbers of one block factorisation, and the operations on single panels of which the whole
/// is composed. Each operation touches one panel only, so that threads may share the panels out.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/linalg/aligned_buffer.hpp"
#include "sinew/linalg/block_symbolic.hpp"
#include "sinew/linalg/dense_kernels.hpp"
#include "sinew/linalg/factor_memory.hpp"

namespace sinew::linalg {

/// What the caller gives to one factorisation.
struct BlockInput {
  const double* matrix;
  const double* border;
  const double* right;
};

/// L, S and the sums of the border, for one BlockSymbolic.
class BlockNumeric {
 public:
  /// Memory that one thread needs beside the factor.
  struct Scratch {
    AlignedBuffer product;  ///< of an update, before it is spread over the target's rows
    AlignedBuffer signed_rows;
    AlignedBuffer values;           ///< a panel's rows in a substitution
    std::vector<int> column_place;  ///< of an update's nodes in the target
  };

  /// @param symbolic must outlive this. @param memory of factors of factor_size(symbolic).
  /// @param threads that factorise.
  BlockNumeric(const BlockSymbolic& symbolic, std::shared_ptr<FactorMemory> memory, int threads);
  /// Doubles.
  static std::size_t factor_size(const BlockSymbolic& symbolic);

  /// Takes memory for the factor, where it holds none. Before the first panel.
  void begin();
  /// Gives it back.
  void release();
  bool holds_factor() const { return factor_.size() > 0; }

  /// Sets panel rows to the entries of A, H and b.
  void assemble(int panel, const BlockInput& input);
  /// Subtracts what all descendants do to panel rows row_begin .. row_end-1.
  void update(int panel, int row_begin, int row_end, Scratch& scratch);
  /// Factorises the diagonal block; of a panel that is not split, the rows below too.
  void factorise(int panel, Scratch& scratch);
  /// Rows row_begin .. row_end-1 of a split panel whose diagonal block is factorised.
  void solve_rows(int panel, int row_begin, int row_end, Scratch& scratch);
  /// Sums up group `group` of the border's updates.
  void update_border(int group, Scratch& scratch);
  /// Adds the groups: -(H; b) A^-1 (H; b)^T, lower triangle, ends in border(0).
  void finish_border();

  /// x := S^-1 L^-1 x, in elimination order.
  void forward(double* x, Scratch& scratch) const;
  /// x := L^-T (x + L_border^T weights), in elimination order. weights (3 border nodes,).
  void backward(double* x, const double* weights, Scratch& scratch) const;

  /// Of a factorised panel: its values, S of its own columns, whether all of them are positive, and
  /// its diagonal block to substitute with.
  const double* values(const Panel& panel) const { return factor_.data() + panel.offset; }
  const double* sign(const Panel& panel) const { return sign_.data() + 3 * panel.first; }
  bool positive(int panel) const { return negatives_[static_cast<std::size_t>(panel)] == 0; }
  DiagonalBlock diagonal_block(int panel, Scratch& scratch);

  const BlockSymbolic& symbolic() const { return *symbolic_; }
  Scratch& scratch(int thread) { return scratch_[static_cast<std::size_t>(thread)]; }
  /// Entry (i, j), i >= j, of the border's panel.
  double border(int i, int j) const;
  int negative_pivots() const;
  bool singular() const;
  std::size_t bytes() const;

 private:
  void apply(const Update& update, const Panel& target, double* panel, int row_begin, int row_end,
             Scratch& scratch) const;
  const BlockSymbolic* symbolic_;
  std::shared_ptr<FactorMemory> memory_;
  AlignedBuffer factor_;   ///< empty: given back
  AlignedBuffer inverse_;  ///< 1 / L_jj; before a panel is factorised, the magnitude of A_jj
  AlignedBuffer sign_;
  AlignedBuffer border_sums_;
  std::vector<int> negatives_;           ///< by panel
  std::vector<unsigned char> singular_;  ///< by panel
  std::vector<Scratch> scratch_;
};

}  // namespace sinew::linalg
