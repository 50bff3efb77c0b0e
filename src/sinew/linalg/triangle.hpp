/// @file
/// What the substitution of a few columns needs of their triangle, for the dense kernels.
#pragma once

#include "sinew/linalg/dense_kernels.hpp"
#include "sinew/linalg/vector_lanes.hpp"

namespace sinew::linalg {

/// factor[k][j] = S_k L_jk for k < j, inverse[j] = 1 / (S_j L_jj), of C columns that follow each
/// other.
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

  /// x := x S^-1 L^-T of these columns. @param x by column: a number of rows in vectors.
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
