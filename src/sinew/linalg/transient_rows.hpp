/// @file
/// Transient rows of a factorisation L S L^T: forward substitution of the active rows, and their
/// part of the compliance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sinew/core/thread_pool.hpp"
#include "sinew/core/types.hpp"
#include "sinew/linalg/block_numeric.hpp"

namespace sinew::linalg {

/// Condensation onto rows H_t that are given at every call. It computes X = H_t L^-T S by panels. A
/// row is non-zero only in the panels on the path from its nodes to the root of the elimination
/// tree, so the work is the same as if these rows were in the border. Then H_t A^-1 H_t^T = X S
/// X^T. The coupling to H and b follows from the border rows of L, which are the same quantity for
/// H and b.
///
/// Rows are processed in chunks, in the order of elimination of their nodes, so that the rows of a
/// chunk share most of their path. Chunks are substituted, and pairs of chunks multiplied,
/// independently: the working set stays in the second-level cache, and threads work in parallel.
/// Allocates only for more rows than ever before.
class TransientRows {
 public:
  /// @param symbolic must outlive this.
  explicit TransientRows(const BlockSymbolic& symbolic);

  /// Computes compliance() and coupling().
  /// @param numeric factorised. @param rows k groups of three rows on the same nodes (a point).
  /// @param values of the rows, layout of BorderPattern. @param pool with as many threads as
  ///   numeric was made for.
  void condense(BlockNumeric& numeric, const BorderPattern& rows, std::span<const double> values,
                ThreadPool& pool);
  /// H_t A^-1 H_t^T, lower triangle only, in the leading block (3 k, 3 k).
  const MatrixX& compliance() const { return compliance_; }
  /// H_t A^-1 (H^T, b), in the leading block (3 k, border rows + 1).
  const MatrixX& coupling() const { return coupling_; }
  std::size_t bytes() const;

 private:
  /// X of one chunk in one panel.
  struct Piece {
    std::int32_t panel = 0;
    std::int32_t count = 0;        // number of groups
    std::int32_t leading = 0;      // doubles from column to column
    std::int64_t offset = 0;       // in values_
    std::size_t first_member = 0;  // in members_
  };
  struct Chunk {
    std::int32_t first = 0, groups = 0;  // in order_
    std::size_t begin = 0, end = 0;      // in pieces_, panels ascending
  };
  struct Scratch {
    AlignedBuffer product, signed_rows, block;
    std::vector<std::int32_t> piece_of;  // by panel: piece of the current chunk, or -1
    std::vector<std::int32_t>
        place;  // place of the groups of a descendant among those of the panel
    std::vector<std::int32_t> column_place;
  };
  struct Rows {
    const double* values;
    long leading;
  };

  template <typename Visit>
  void for_panels(const BorderPattern& rows, std::int32_t group, std::int32_t stamp, Visit&& visit);
  void prepare(int threads);
  void order(const BorderPattern& rows);
  void list(const BorderPattern& rows);
  void list_chunk(const BorderPattern& rows, Chunk& chunk);
  void substitute(BlockNumeric& numeric, const Chunk& chunk, const BorderPattern& rows,
                  std::span<const double> values, int thread);
  void fill(const Chunk& chunk, const Piece& piece, const BorderPattern& rows,
            std::span<const double> values);
  void update(const BlockNumeric& numeric, const Piece& piece, Scratch& scratch);
  void couple(const BlockNumeric& numeric, const Chunk& chunk, const Piece& piece,
              Scratch& scratch);
  void multiply_chunks(const BlockNumeric& numeric, const Chunk& left, const Chunk& right,
                       Scratch& scratch);
  void place_block(const Chunk& left, const Chunk& right, const double* block, long leading);
  static Rows with_signs(const BlockNumeric& numeric, const Panel& panel, bool positive, Rows rows,
                         int count, Scratch& scratch);
  const double* values_of(const Piece& piece) const { return values_.data() + piece.offset; }
  double* values_of(const Piece& piece) { return values_.data() + piece.offset; }
  std::span<const std::int32_t> members(const Piece& piece) const {
    return {members_.data() + piece.first_member, static_cast<std::size_t>(piece.count)};
  }

  const BlockSymbolic* symbolic_;
  std::vector<std::int32_t> panel_of_;  // by position in the order of elimination
  std::vector<std::int32_t> stamp_;     // by panel: stamp of its last visit
  std::vector<std::int32_t> count_;     // by panel: groups of the chunk being listed
  std::vector<std::int32_t> touched_;   // the panels of that chunk
  std::vector<std::int32_t> order_;     // groups by the elimination of their first node
  std::vector<std::int32_t> first_position_;
  std::vector<Chunk> chunks_;
  std::vector<Piece> pieces_;
  std::vector<std::int32_t> members_;  // by piece: numbers in the chunk, ascending
  AlignedBuffer values_;
  MatrixX compliance_, coupling_;
  std::vector<Scratch> scratch_;
};

}  // namespace sinew::linalg
