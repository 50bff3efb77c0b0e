#include "sinew/linalg/dense_kernels.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/linalg/vector_lanes.hpp"

namespace sinew::linalg {

namespace {

/// Columns of a tile: two nodes. With kMaxVectors vectors of rows its sums fill the registers.
constexpr int kTileColumns = 6;
constexpr int kMaxVectors = kLanes == 8 ? 4 : 2;
/// A pivot below this fraction of its original diagonal is taken as zero: what rounding leaves of a
/// rigid motion is of the order of 1e-15, the softest mode of a slender robot of 1e-9.
constexpr double kPivotTolerance = 1e-13;

/// Calls work.template operator()<V>(row) for pieces of V * kLanes rows that cover [begin, end).
template <typename Work>
void for_row_tiles(int begin, int end, Work&& work) {
  for (int row = begin; row < end;) {
    const int left = (end - row + kLanes - 1) / kLanes;
    const int vectors = left <= kMaxVectors      ? left
                        : left < 2 * kMaxVectors ? (left + 1) / 2
                                                 : kMaxVectors;
    switch (vectors) {
      case 1:
        work.template operator()<1>(row);
        break;
      case 2:
        work.template operator()<2>(row);
        break;
      case 3:
        work.template operator()<3>(row);
        break;
      default:
        work.template operator()<4>(row);
        break;
    }
    row += vectors * kLanes;
  }
}

enum class Store { assign, subtract };

template <int V, int C, Store mode>
inline void product_tile(const Product& p, int row, int column, double* c, long leading) {
  Lanes sum[C][V] = {};
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
      store(at, mode == Store::assign ? sum[j][v] : load(at) - sum[j][v]);
    }
  }
}

enum class Part { lower, whole };

template <Store mode, Part part = Part::lower>
void product_rows(const Product& p, int row_begin, int row_end, double* c, long leading) {
  const auto strip = [&]<int C>(int column) {
    const int first = part == Part::whole ? row_begin : std::max(row_begin, column);
    for_row_tiles(first, row_end, [&]<int V>(int row) {
      if constexpr (V <= kMaxVectors) {
        product_tile<V, C, mode>(p, row, column, c + (row - row_begin) + column * leading, leading);
      }
    });
  };
  int column = 0;
  for (; column + kTileColumns <= p.columns; column += kTileColumns) {
    strip.template operator()<kTileColumns>(column);
  }
  if (column < p.columns) strip.template operator()<3>(column);
}

/// What the substitution of C columns needs of their triangle: factor[k][j] = S_k L_jk for k < j,
/// inverse[j] = 1 / (S_j L_jj).
template <int C>
struct Triangle {
  double factor[C][C];
  double inverse[C];

  Triangle(const DiagonalBlock& block, int column) {
    for (int j = 0; j < C; ++j) {
      inverse[j] = block.inverse[column + j] * block.sign[column + j];
      for (int k = 0; k < j; ++k) {
        factor[k][j] =
            block.panel[column + j + (column + k) * block.leading] * block.sign[column + k];
      }
    }
  }
};

/// Rows of S L for the columns column .. column + C - 1, to multiply with: the panel itself unless
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

/// Left-looking substitution of a tile: subtracts what the columns before did, then solves with the
/// triangle in registers.
template <int V, int C>
inline void solve_tile(const Product& p, const Triangle<C>& t, int row, double* c) {
  Lanes x[C][V];
  load_minus_product<V, C>(p, row, c, x);
  SINEW_UNROLL for (int j = 0; j < C; ++j) {
    SINEW_UNROLL for (int k = 0; k < C; ++k) {
      if (k >= j) continue;
      const Lanes y = broadcast(t.factor[k][j]);
      SINEW_UNROLL for (int v = 0; v < V; ++v) x[j][v] -= x[k][v] * y;
    }
    const Lanes y = broadcast(t.inverse[j]);
    SINEW_UNROLL for (int v = 0; v < V; ++v) {
      x[j][v] *= y;
      store(c + j * p.leading_a + v * kLanes, x[j][v]);
    }
  }
}

/// A pivot that may be divided by; counts negative ones and marks vanishing ones.
inline double accept_pivot(DiagonalBlock& block, double pivot, double magnitude) {
  if (!(std::abs(pivot) > kPivotTolerance * magnitude)) {  // also for NaN
    block.singular = true;
    return magnitude > 0 ? magnitude : 1.0;
  }
  return pivot;
}

/// Factorises the triangle of C columns, with the rest of the rows that its vectors reach.
/// Eliminates as L D L^T, whose chain from pivot to pivot holds one division, and scales by
/// |D|^1/2 at the end.
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
  const Triangle<C> triangle(block, column);
  double* const c = block.panel + column * block.leading;
  for_row_tiles(begin, end, [&]<int V>(int row) {
    if constexpr (V <= kMaxVectors) solve_tile<V, C>(p, triangle, row, c + row);
  });
}

/// Calls work.template operator()<C>(column) for the strips of the columns, forward.
template <typename Work>
void for_strips(int columns, Work&& work) {
  int column = 0;
  for (; column + kTileColumns <= columns; column += kTileColumns) {
    work.template operator()<kTileColumns>(column);
  }
  if (column < columns) work.template operator()<3>(column);
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

void multiply(const Product& product, int row_begin, int row_end, double* w, long leading_w) {
  product_rows<Store::assign>(product, row_begin, row_end, w, leading_w);
}

void multiply_whole(const Product& product, int rows, double* w, long leading_w) {
  product_rows<Store::assign, Part::whole>(product, 0, rows, w, leading_w);
}

void multiply_subtract(const Product& product, int rows, double* c, long leading_c) {
  product_rows<Store::subtract>(product, 0, rows, c, leading_c);
}

void factorise_panel(DiagonalBlock& block, int row_end) {
  block.negatives = 0;
  block.singular = false;
  for_strips(block.columns, [&]<int C>(int column) {
    constexpr int reached = (C + kLanes - 1) / kLanes * kLanes;
    const Product finished = finished_columns<C>(block, column);
    factorise_tile<C>(block, finished, column);
    solve_strip<C>(block, finished, column, column + reached, row_end);
  });
}

void solve_panel_rows(const DiagonalBlock& block, int row_begin, int row_end) {
  for_strips(block.columns, [&]<int C>(int column) {
    solve_strip<C>(block, finished_columns<C>(block, column), column, row_begin, row_end);
  });
}

void solve_rows_apart(const DiagonalBlock& block, double* rows, long leading, int count) {
  for_strips(block.columns, [&]<int C>(int column) {
    const Triangle<C> triangle(block, column);
    Product finished = finished_columns<C>(block, column);
    finished.a = rows;
    finished.leading_a = leading;
    double* const c = rows + column * leading;
    for_row_tiles(0, count, [&]<int V>(int row) {
      if constexpr (V <= kMaxVectors) solve_tile<V, C>(finished, triangle, row, c + row);
    });
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
