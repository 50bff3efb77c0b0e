// Goto & van de Geijn, Anatomy of high-performance matrix multiplication, ACM Trans. Math. Software
// 34 (2008), with the roles of the caches exchanged: a tile of A stays in the first-level cache
// while it is multiplied by all strips of a block of B, which fill the second-level cache.
#include "sinew/linalg/packed_product.hpp"

#include <algorithm>

#include "sinew/linalg/tiles.hpp"

namespace sinew::linalg {

namespace {

constexpr int kPackedDepth = 144;    // the widest panel
constexpr int kPackedColumns = 144;  // of B; with the depth, part of the second-level cache
static_assert(kPackedColumns % kTileColumns == 0);

/// Strips of B, one after the other; within a strip, the values of all columns for each k are
/// contiguous.
struct PackedStrips {
  alignas(64) double values[kPackedDepth * kPackedColumns];
  int depth;

  void fill(const Product& p, int column_begin, int columns, int k_begin) {
    for (int k = 0; k < depth; ++k) {
      const double* const b = p.b + (k_begin + k) * p.leading_b + column_begin;
      for_strips(columns, [&]<int C>(int column) {
        double* const to = values + column * depth + C * k;
        SINEW_UNROLL for (int j = 0; j < C; ++j) to[j] = b[column + j];
      });
    }
  }
};

template <int V>
void pack_rows(const double* a, long leading, int depth, double* to) {
  for (int k = 0; k < depth; ++k, a += leading, to += V * kLanes) {
    SINEW_UNROLL for (int v = 0; v < V; ++v) store(to + v * kLanes, load(a + v * kLanes));
  }
}

template <int V, int C>
inline void packed_tile(const double* a, const double* b, int depth, Store mode, double* c,
                        long leading) {
  Lanes sum[C][V] = {};
  if (mode == Store::add) {
    SINEW_UNROLL for (int j = 0; j < C; ++j) {
      SINEW_UNROLL for (int v = 0; v < V; ++v) sum[j][v] = load(c + j * leading + v * kLanes);
    }
  }
  for (int left = depth; left > 0; --left, a += V * kLanes, b += C) {
    Lanes x[V];
    SINEW_UNROLL for (int v = 0; v < V; ++v) x[v] = load(a + v * kLanes);
    SINEW_UNROLL for (int j = 0; j < C; ++j) {
      const Lanes y = broadcast(b[j]);
      SINEW_UNROLL for (int v = 0; v < V; ++v) sum[j][v] += x[v] * y;
    }
  }
  if (mode == Store::subtract) {
    SINEW_UNROLL for (int j = 0; j < C; ++j) {
      SINEW_UNROLL for (int v = 0; v < V; ++v) {
        double* const at = c + j * leading + v * kLanes;
        store(at, load(at) - sum[j][v]);
      }
    }
    return;
  }
  SINEW_UNROLL for (int j = 0; j < C; ++j) {
    SINEW_UNROLL for (int v = 0; v < V; ++v) store(c + j * leading + v * kLanes, sum[j][v]);
  }
}

}  // namespace

void multiply_packed(const Product& product, int row_begin, int row_end, double* c, long leading,
                     Store store, Part part) {
  PackedStrips strips;
  alignas(64) double rows[kPackedDepth * kMaxVectors * kLanes];
  for (int from = 0; from < product.columns; from += kPackedColumns) {
    const int columns = std::min(kPackedColumns, product.columns - from);
    const int first = part == Part::whole ? row_begin : std::max(row_begin, from);
    if (first >= row_end) return;
    Store mode = store;
    for (int k = 0; k < product.depth; k += kPackedDepth) {
      strips.depth = std::min(kPackedDepth, product.depth - k);
      strips.fill(product, from, columns, k);
      for_row_tiles(first, row_end, [&]<int V>(int row) {
        pack_rows<V>(product.a + row + k * product.leading_a, product.leading_a, strips.depth,
                     rows);
        double* const to = c + (row - row_begin) + from * leading;
        const int reached =
            part == Part::whole ? columns : std::min(columns, row + V * kLanes - from);
        for_strips(columns, [&]<int C>(int column) {
          if (column >= reached) return;
          packed_tile<V, C>(rows, strips.values + column * strips.depth, strips.depth, mode,
                            to + column * leading, leading);
        });
      });
      if (mode == Store::assign) mode = Store::add;
    }
  }
}

}  // namespace sinew::linalg
