// clang-format off
/// @file
/// Symbolic block factorisation: the layout of the panels of L, which panels update which, and the
/// destination of every entry of A, H and b.
///
/// L is stored in panels, one per supernode, column-major:
///
///     rows 0 .. 3w-1              the w nodes of the supernode (lower triangle of L)
///     8 to 15 rows of zeros       in split panels only: tiles of the diagonal block may overrun,
///                                 and the rows below begin at a multiple of 8
///     rows below .. below+3r-1    the r nodes below, ascending, border nodes last
///     at least 7 rows of zeros    full-width tiles may overrun the end
///
/// The next column starts `leading` doubles later. The last panel is that of the border: all others
/// update it, it is never factorised, and it ends as -(H; b) A^-1 (H; b)^T.
// clang-format on
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/linalg/block_pattern.hpp"
#include "sinew/linalg/supernodes.hpp"

namespace sinew::linalg {

/// A run of rows that are contiguous in the source and in the target panel. Unit: doubles.
struct RowRun {
  std::int32_t source;  ///< first row, counted from the first row of the update
  std::int32_t target;  ///< first row in the target panel
  std::int32_t length;
};

/// Eight rows of a target panel, starting at a multiple of 8, and the rows of an update that belong
/// there. Rows ascend on both sides, so they are consecutive in the source.
struct RowWindow {
  std::int32_t source;  ///< first of these rows, counted from the first row of the update
  std::int32_t target;  ///< first row of the window
  std::uint8_t mask;    ///< bit r: row target + r receives a row
};

/// Update of a panel by one descendant d: panel -= L_d(rows, :) S L_d(columns, :)^T.
struct Update {
  std::int32_t descendant;
  std::int32_t first;    ///< row of the descendant panel where rows and columns begin
  std::int32_t rows;     ///< doubles, including `columns`
  std::int32_t columns;  ///< doubles; the first rows are the columns of the target
  std::int32_t run_begin, run_end;
  std::int32_t window_begin, window_end;
};

/// Source and destination of one 3x3 block, or of one 3-vector of a border row.
struct BlockScatter {
  std::int32_t source;  ///< first double in the array of the caller
  std::int32_t target;  ///< first double in the panel
};

/// A panel of L and the lists that fill it.
struct Panel {
  std::int32_t first = 0;    ///< first node, in elimination order
  std::int32_t width = 0;    ///< nodes
  std::int32_t below = 0;    ///< panel row of the first node below
  std::int32_t height = 0;   ///< rows in use, without the padding at the end
  std::int32_t leading = 0;  ///< doubles from column to column
  std::int64_t offset = 0;   ///< first double in the factor
  std::int32_t parent = -1;  ///< panel of the first node below; the border panel at a root
  bool split = false;        ///< whether its rows are divided between threads
  std::int32_t row_begin = 0, row_end = 0;  ///< the nodes below, in `rows`
  std::int32_t border_row = 0;              ///< first border node, in `rows`
  std::int32_t update_begin = 0, update_end = 0;
  std::int32_t straight_begin = 0, straight_end = 0;      ///< blocks placed as they are
  std::int32_t transposed_begin = 0, transposed_end = 0;  ///< blocks placed transposed
  std::int32_t border_begin = 0, border_end = 0;          ///< entries of H
  std::int32_t right_row = 0;                             ///< panel row of b
  double flops = 0;                                       ///< of its updates and factorisation
};

/// The symbolic factorisation.
struct BlockSymbolic {
  int nodes = 0;
  int border_rows = 0;                 ///< m
  int border_nodes = 0;                ///< groups of three that hold the m rows and b
  std::vector<std::int32_t> order;     ///< node eliminated k-th
  std::vector<std::int32_t> position;  ///< its inverse
  std::vector<Panel> panels;           ///< the last one is that of the border
  std::vector<std::int32_t> rows;
  std::vector<Update> updates;
  std::vector<RowRun> runs;        ///< of the updates
  std::vector<RowWindow> windows;  ///< the same rows, for vectors of 8
  std::vector<BlockScatter> straight, transposed, border;
  /// The border updates are summed within groups of panels, then over the groups in order, so that
  /// the result does not depend on the number of threads. Group c consists of panels group_start[c]
  /// .. group_start[c+1]-1.
  std::vector<std::int32_t> group_start;
  std::int64_t doubles = 0;  ///< length of the factor, without the border panel
  std::int64_t entries = 0;  ///< doubles of L in use
  double flops = 0;
  int max_leading = 0;
  int max_width = 0;  ///< doubles

  BlockSymbolic(const BlockPattern& pattern, const BorderPattern& border_pattern, Ordering ordering,
                const SupernodeSettings& settings);

  int panel_count() const { return static_cast<int>(panels.size()) - 1; }
  const Panel& border_panel() const { return panels.back(); }
};

}  // namespace sinew::linalg
