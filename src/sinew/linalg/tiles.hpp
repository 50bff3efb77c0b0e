/// @file
/// Division of rows and columns into tiles whose sums stay in registers, for the dense kernels.
#pragma once

#include "sinew/linalg/vector_lanes.hpp"

namespace sinew::linalg {

/// Columns of a tile: two nodes. With kMaxVectors vectors of rows, the sums of a tile fill the
/// registers.
inline constexpr int kTileColumns = 6;
inline constexpr int kMaxVectors = kLanes == 8 ? 4 : 2;

/// Calls work with the template argument V for each tile of V * kLanes rows from `row` on. The
/// tiles cover rows begin .. end-1.
template <typename Work>
void for_row_tiles(int begin, int end, Work&& work) {
  for (int row = begin; row < end;) {
    const int left = (end - row + kLanes - 1) / kLanes;
    const int vectors = left <= kMaxVectors      ? left
                        : left < 2 * kMaxVectors ? (left + 1) / 2
                                                 : kMaxVectors;
    if constexpr (kMaxVectors > 2) {
      if (vectors == 4) work.template operator()<4>(row);
      if (vectors == 3) work.template operator()<3>(row);
    }
    if (vectors == 2) work.template operator()<2>(row);
    if (vectors == 1) work.template operator()<1>(row);
    row += vectors * kLanes;
  }
}

/// Calls work with the template argument C for each strip of C columns from `column` on, in
/// ascending order.
template <typename Work>
void for_strips(int columns, Work&& work) {
  int column = 0;
  for (; column + kTileColumns <= columns; column += kTileColumns) {
    work.template operator()<kTileColumns>(column);
  }
  if (column < columns) work.template operator()<3>(column);
}

}  // namespace sinew::linalg
