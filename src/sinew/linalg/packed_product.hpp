/// @file
/// Products of panels whose operands are copied tile by tile into memory without gaps. A column of
/// a large panel is one page of memory after the other: a tile that reads it in place waits for the
/// cache at every number.
#pragma once

#include "sinew/linalg/dense_kernels.hpp"

namespace sinew::linalg {

/// Whether copies cost less than they save: columns of fewer numbers lie close together. By the
/// shape alone, and the bits are the same either way but for `subtract` with sums of more than 144
/// numbers.
inline bool worth_packing(const Product& product, int rows) {
  return rows >= 48 && product.columns >= 48 && product.depth >= 48 &&
         (product.leading_a >= 320 || product.leading_b >= 320);
}

/// As multiply().
void multiply_packed(const Product& product, int row_begin, int row_end, double* c, long leading,
                     Store store, Part part);

}  // namespace sinew::linalg
