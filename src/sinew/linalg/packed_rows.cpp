#include "sinew/linalg/packed_rows.hpp"

#include "sinew/linalg/tiles.hpp"
#include "sinew/linalg/triangle.hpp"

namespace sinew::linalg {

namespace {

constexpr int kStrips = kMaxPackedBlock / kTileColumns;
static_assert(kStrips * kTileColumns == kMaxPackedBlock);

/// Rows of S L, strip by strip: the rows of the C columns of a strip in all previous columns, with
/// the C values of each column contiguous; and the triangles of the strips.
struct PackedBlock {
  alignas(64) double values[kTileColumns * kTileColumns * kStrips * (kStrips - 1) / 2];
  Triangle<kTileColumns> triangles[kStrips];
  Triangle<3> last;

  explicit PackedBlock(const DiagonalBlock& block) {
    for_strips(block.columns, [&]<int C>(int column) {
      if constexpr (C == kTileColumns) triangles[column / kTileColumns].take(block, column);
      if constexpr (C != kTileColumns) last.take(block, column);
      double* to = values + first(column);
      const double* from = block.panel + column;
      for (int k = 0; k < column; ++k, from += block.leading, to += C) {
        SINEW_UNROLL for (int j = 0; j < C; ++j) to[j] = from[j] * block.sign[k];
      }
    });
  }

  /// Start of the strip of a column.
  static int first(int column) { return column * (column - kTileColumns) / 2; }
  template <int C>
  const Triangle<C>& triangle(int column) const {
    if constexpr (C == kTileColumns) {
      return triangles[column / kTileColumns];
    } else {
      return last;
    }
  }
};

/// Left-looking substitution: subtracts the contributions of the previous columns, then solves with
/// the triangle. @param done previous columns of the tile, contiguous.
template <int V, int C>
inline void solve_strip_packed(const PackedBlock& block, int column, double* done, double* c,
                               long leading) {
  Lanes x[C][V];
  SINEW_UNROLL for (int j = 0; j < C; ++j) {
    SINEW_UNROLL for (int v = 0; v < V; ++v) x[j][v] = load(c + j * leading + v * kLanes);
  }
  const double* a = done;
  const double* b = block.values + PackedBlock::first(column);
  for (int left = column; left > 0; --left, a += V * kLanes, b += C) {
    Lanes y[V];
    SINEW_UNROLL for (int v = 0; v < V; ++v) y[v] = load(a + v * kLanes);
    SINEW_UNROLL for (int j = 0; j < C; ++j) {
      const Lanes factor = broadcast(b[j]);
      SINEW_UNROLL for (int v = 0; v < V; ++v) x[j][v] -= y[v] * factor;
    }
  }
  block.triangle<C>(column).substitute(x);
  double* const own = done + column * V * kLanes;
  SINEW_UNROLL for (int j = 0; j < C; ++j) {
    SINEW_UNROLL for (int v = 0; v < V; ++v) {
      store(own + (j * V + v) * kLanes, x[j][v]);
      store(c + j * leading + v * kLanes, x[j][v]);
    }
  }
}

}  // namespace

void solve_rows_packed(const DiagonalBlock& block, double* rows, long leading, int count) {
  const PackedBlock packed(block);
  alignas(64) double done[kMaxPackedBlock * kMaxVectors * kLanes];
  for_row_tiles(0, count, [&]<int V>(int row) {
    for_strips(block.columns, [&]<int C>(int column) {
      solve_strip_packed<V, C>(packed, column, done, rows + row + column * leading, leading);
    });
  });
}

}  // namespace sinew::linalg
