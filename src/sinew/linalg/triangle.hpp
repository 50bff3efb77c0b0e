/// @file
/// Triangle of a few columns for substitution, in the dense kernels.
#pragma once

#include "sinew/linalg/dense_kernels.hpp"
#include "sinew/linalg/vector_lanes.hpp"

namespace sinew::linalg {

/// The triangle of C consecutive columns: factor[k][j] = S_k L_jk for k < j, inverse[j] = 1 / (S_j
/// L_jj).
template <int C>
struct Triangle {
  double factor[C][C];
  double inverse[C];

  void take(const DiagonalBlock& block, int column) {
    for (int j = 0; j < C; ++j) {
      inverse[j] = block.inverse[column + j] * block.sign[column + j];
      for (int k = 0; k < j; ++k) {
        factor[k][j] =
            block.panel[column + j + (column + k) * block.leading] * block.sign[column + k];
      }
    }
  }

  /// Substitutes x := x S^-1 L^-T for these columns. @param x by column, V vectors of rows.
  template <int V>
  void substitute(Lanes (&x)[C][V]) const {
    SINEW_UNROLL for (int j = 0; j < C; ++j) {
      SINEW_UNROLL for (int k = 0; k < C; ++k) {
        if (k >= j) continue;
        const Lanes y = broadcast(factor[k][j]);
        SINEW_UNROLL for (int v = 0; v < V; ++v) x[j][v] -= x[k][v] * y;
      }
      const Lanes y = broadcast(inverse[j]);
      SINEW_UNROLL for (int v = 0; v < V; ++v) x[j][v] *= y;
    }
  }
};

}  // namespace sinew::linalg
