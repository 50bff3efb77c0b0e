#include "sinew/linalg/dense_kernels.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/linalg/packed_product.hpp"
#include "sinew/linalg/packed_rows.hpp"
#include "sinew/linalg/tiles.hpp"
#include "sinew/linalg/triangle.hpp"

namespace sinew::linalg {

namespace {

/// A pivot below this fraction of its original diagonal counts as zero. Rounding leaves about 1e-15
/// for a rigid motion; the softest mode of a slender robot has about 1e-9.
constexpr double kPivotTolerance = 1e-13;
/// Minimum number of rows below a diagonal block for which a copy of it pays.
constexpr int kMinRowsApart = 96;

// Not inlined, so that the values of the callers do not occupy registers.
template <int V, int C, Store mode>
[[gnu::noinline]] void product_tile(const Product& p, int row, int column, double* c,
                                    long leading) {
  Lanes sum[C][V] = {};
  if constexpr (mode == Store::add) {
    SINEW_UNROLL for (int j = 0; j < C; ++j) {
      SINEW_UNROLL for (int v = 0; v < V; ++v) sum[j][v] = load(c + j * leading + v * kLanes);
    }
  }
  const double* a = p.a + row;
  const double* b = p.b + column;
  for (int left = p.depth; left > 0; --left, a += p.leading_a, b += p.leading_b) {
    Lanes x[V];
    SINEW_UNROLL for (int v = 0; v < V; ++v) x[v] = load(a + v * kLanes);
    SINEW_UNROLL for (int j = 0; j < C; ++j) {
      const Lanes y = broadcast(b[j]);
      SINEW_UNROLL for (int v = 0; v < V; ++v) sum[j][v] += x[v] * y;
    }
  }
  SINEW_UNROLL for (int j = 0; j < C; ++j) {
    SINEW_UNROLL for (int v = 0; v < V; ++v) {
      double* const at = c + j * leading + v * kLanes;
      store(at, mode == Store::subtract ? load(at) - sum[j][v] : sum[j][v]);
    }
  }
}

template <Store mode>
void product_rows(const Product& p, int row_begin, int row_end, double* c, long leading,
                  Part part) {
  const auto strip = [&]<int C>(int column) {
    const int first = part == Part::whole ? row_begin : std::max(row_begin, column);
    for_row_tiles(first, row_end, [&]<int V>(int row) {
      product_tile<V, C, mode>(p, row, column, c + (row - row_begin) + column * leading, leading);
    });
  };
  for_strips(p.columns, strip);
}

/// Rows of S L for the columns column .. column + C - 1, as an operand: the panel itself unless
/// there are negative pivots.
template <int C>
Product finished_columns(const DiagonalBlock& block, int column) {
  const double* const b = block.panel + column;
  if (block.negatives == 0) return {block.panel, block.leading, b, block.leading, column, C};
  for (int k = 0; k < column; ++k) {
    for (int j = 0; j < C; ++j) {
      block.scratch[kTileColumns * k + j] = b[k * block.leading + j] * block.sign[k];
    }
  }
  return {block.panel, block.leading, block.scratch, kTileColumns, column, C};
}

template <int V, int C>
inline void load_minus_product(const Product& p, int row, const double* c, Lanes (&sum)[C][V]) {
  SINEW_UNROLL for (int j = 0; j < C; ++j) {
    SINEW_UNROLL for (int v = 0; v < V; ++v) sum[j][v] = load(c + j * p.leading_a + v * kLanes);
  }
  const double* a = p.a + row;
  const double* b = p.b;
  for (int left = p.depth; left > 0; --left, a += p.leading_a, b += p.leading_b) {
    Lanes x[V];
    SINEW_UNROLL for (int v = 0; v < V; ++v) x[v] = load(a + v * kLanes);
    SINEW_UNROLL for (int j = 0; j < C; ++j) {
      const Lanes y = broadcast(b[j]);
      SINEW_UNROLL for (int v = 0; v < V; ++v) sum[j][v] -= x[v] * y;
    }
  }
}

/// Left-looking substitution of a tile: subtracts the contributions of the previous columns, then
/// solves with the triangle in registers.
template <int V, int C>
inline void solve_tile(const Product& p, const Triangle<C>& t, int row, double* c) {
  Lanes x[C][V];
  load_minus_product<V, C>(p, row, c, x);
  t.substitute(x);
  SINEW_UNROLL for (int j = 0; j < C; ++j) {
    SINEW_UNROLL for (int v = 0; v < V; ++v) store(c + j * p.leading_a + v * kLanes, x[j][v]);
  }
}

/// Returns a pivot that can be a divisor: replaces vanishing pivots, and marks the block as
/// singular.
inline double accept_pivot(DiagonalBlock& block, double pivot, double magnitude) {
  if (!(std::abs(pivot) > kPivotTolerance * magnitude)) {  // also for NaN
    block.singular = true;
    return magnitude > 0 ? magnitude : 1.0;
  }
  return pivot;
}

/// Factorises the triangle of C columns, with the other rows in its vectors. Eliminates as L D L^T,
/// which has one division per pivot in its dependency chain, and scales by |D|^1/2 at the end.
template <int C>
inline void factorise_tile(DiagonalBlock& block, const Product& p, int column) {
  constexpr int V = (C + kLanes - 1) / kLanes;
  double* const c = block.panel + column + column * block.leading;
  Lanes x[C][V];
  load_minus_product<V, C>(p, column, c, x);
  double pivots[C];
  SINEW_UNROLL for (int j = 0; j < C; ++j) {
    alignas(64) double lane[V * kLanes];
    SINEW_UNROLL for (int v = 0; v < V; ++v) store(lane + v * kLanes, x[j][v]);
    pivots[j] = accept_pivot(block, x[j][j / kLanes][j % kLanes], block.inverse[column + j]);
    const Lanes reciprocal = broadcast(1.0 / pivots[j]);
    SINEW_UNROLL for (int k = 0; k < C; ++k) {
      if (k <= j) continue;
      const Lanes y = broadcast(lane[k]);
      SINEW_UNROLL for (int v = 0; v < V; ++v) x[k][v] -= (x[j][v] * y) * reciprocal;
    }
  }
  SINEW_UNROLL for (int j = 0; j < C; ++j) {
    const double inverse = 1.0 / std::sqrt(std::abs(pivots[j]));
    const double sign = pivots[j] < 0 ? -1.0 : 1.0;
    block.inverse[column + j] = inverse;
    block.sign[column + j] = sign;
    block.negatives += pivots[j] < 0 ? 1 : 0;
    const Lanes scale = broadcast(inverse * sign);
    SINEW_UNROLL for (int v = 0; v < V; ++v) {
      store(c + j * block.leading + v * kLanes, x[j][v] * scale);
    }
  }
}

template <int C>
void solve_strip(const DiagonalBlock& block, const Product& p, int column, int begin, int end) {
  Triangle<C> triangle;
  triangle.take(block, column);
  double* const c = block.panel + column * block.leading;
  for_row_tiles(begin, end, [&]<int V>(int row) { solve_tile<V, C>(p, triangle, row, c + row); });
}

/// Factorises rows 0 .. columns-1, and solves for the rows below up to row_end.
void factorise_strips(DiagonalBlock& block, int row_end) {
  for_strips(block.columns, [&]<int C>(int column) {
    constexpr int reached = (C + kLanes - 1) / kLanes * kLanes;
    const Product finished = finished_columns<C>(block, column);
    factorise_tile<C>(block, finished, column);
    solve_strip<C>(block, finished, column, column + reached, row_end);
  });
}

/// Factorises only rows 0 .. columns-1, in a copy, since tiles overrun its end, where the panel has
/// other rows.
void factorise_apart(DiagonalBlock& block) {
  constexpr long leading = kMaxPackedBlock + kOverrun;
  alignas(64) double copy[kMaxPackedBlock * leading + kOverrun];
  DiagonalBlock apart = block;
  apart.panel = copy;
  apart.leading = leading;
  const int size = block.columns;
  for (int j = 0; j < size; ++j) {
    const int above = j % kTileColumns;
    std::fill_n(copy + j - above + j * leading, above, 0.0);
    std::copy_n(block.panel + j + j * block.leading, size - j, copy + j + j * leading);
    std::fill_n(copy + size + j * leading, kOverrun, 0.0);
  }
  factorise_strips(apart, size);
  for (int j = 0; j < size; ++j) {
    std::copy_n(copy + j + j * leading, size - j, block.panel + j + j * block.leading);
  }
  block.negatives = apart.negatives;
  block.singular = apart.singular;
}

template <int Bytes>
inline double sum_lanes(double __attribute__((vector_size(Bytes))) x) {
  if constexpr (Bytes == 16) {
    return x[0] + x[1];
  } else {
    double __attribute__((vector_size(Bytes / 2))) half[2];
    std::memcpy(&half, &x, sizeof x);
    return sum_lanes<Bytes / 2>(half[0] + half[1]);
  }
}

template <int C>
inline void backward_strip(const double* panel, long leading, int column, int height,
                           const double* inverse, double* v) {
  const double* const c = panel + column * leading;
  Lanes sum[C] = {};
  for (int row = column + C; row < height; row += kLanes) {
    const Lanes x = load(v + row);
    SINEW_UNROLL for (int j = 0; j < C; ++j) sum[j] += load(c + j * leading + row) * x;
  }
  double y[C];
  SINEW_UNROLL for (int j = 0; j < C; ++j) {
    y[j] = v[column + j] - sum_lanes<static_cast<int>(sizeof(Lanes))>(sum[j]);
  }
  for (int j = C; j-- > 0;) {
    const double x = y[j] * inverse[column + j];
    v[column + j] = x;
    for (int k = 0; k < j; ++k) y[k] -= c[k * leading + column + j] * x;
  }
}

template <int C>
inline void forward_strip(const double* panel, long leading, int column, int height,
                          const double* inverse, double* v) {
  const double* const c = panel + column * leading;
  double u[C];
  for (int j = 0; j < C; ++j) {
    u[j] = v[column + j] * inverse[column + j];
    v[column + j] = u[j];
    for (int k = j + 1; k < C; ++k) v[column + k] -= c[j * leading + column + k] * u[j];
  }
  for (int row = column + C; row < height; row += kLanes) {
    Lanes x = load(v + row);
    SINEW_UNROLL for (int j = 0; j < C; ++j) x -= load(c + j * leading + row) * broadcast(u[j]);
    store(v + row, x);
  }
}

}  // namespace

void multiply(const Product& product, int row_begin, int row_end, double* c, long leading,
              Store store, Part part) {
  if (worth_packing(product, row_end - row_begin)) {
    multiply_packed(product, row_begin, row_end, c, leading, store, part);
    return;
  }
  switch (store) {
    case Store::assign:
      product_rows<Store::assign>(product, row_begin, row_end, c, leading, part);
      break;
    case Store::add:
      product_rows<Store::add>(product, row_begin, row_end, c, leading, part);
      break;
    case Store::subtract:
      product_rows<Store::subtract>(product, row_begin, row_end, c, leading, part);
      break;
  }
}

void factorise_panel(DiagonalBlock& block, int row_end) {
  block.negatives = 0;
  block.singular = false;
  if (row_end - block.columns >= kMinRowsApart && worth_packing(block, row_end - block.columns)) {
    factorise_apart(block);
    solve_rows_packed(block, block.panel + block.columns, block.leading, row_end - block.columns);
  } else {
    factorise_strips(block, row_end);
  }
}

void solve_panel_rows(const DiagonalBlock& block, int row_begin, int row_end) {
  if (worth_packing(block, row_end - row_begin)) {
    solve_rows_packed(block, block.panel + row_begin, block.leading, row_end - row_begin);
    return;
  }
  for_strips(block.columns, [&]<int C>(int column) {
    solve_strip<C>(block, finished_columns<C>(block, column), column, row_begin, row_end);
  });
}

void solve_rows_apart(const DiagonalBlock& block, double* rows, long leading, int count) {
  if (worth_packing(block, count)) {
    solve_rows_packed(block, rows, leading, count);
    return;
  }
  for_strips(block.columns, [&]<int C>(int column) {
    Triangle<C> triangle;
    triangle.take(block, column);
    Product finished = finished_columns<C>(block, column);
    finished.a = rows;
    finished.leading_a = leading;
    double* const c = rows + column * leading;
    for_row_tiles(0, count,
                  [&]<int V>(int row) { solve_tile<V, C>(finished, triangle, row, c + row); });
  });
}

void backward_panel(const double* panel, long leading, int columns, int height,
                    const double* inverse, double* v) {
  const int rest = columns % kTileColumns;
  int column = columns - rest;
  if (rest > 0) backward_strip<3>(panel, leading, column, height, inverse, v);
  while (column > 0) {
    column -= kTileColumns;
    backward_strip<kTileColumns>(panel, leading, column, height, inverse, v);
  }
}

void forward_panel(const double* panel, long leading, int columns, int height,
                   const double* inverse, double* v) {
  for_strips(columns, [&]<int C>(int column) {
    forward_strip<C>(panel, leading, column, height, inverse, v);
  });
}

}  // namespace sinew::linalg
