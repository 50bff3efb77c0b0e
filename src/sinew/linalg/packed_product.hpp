/// @file
/// Products of panels whose operands are first copied, tile by tile, into contiguous memory. In a
/// large panel, consecutive columns are on different memory pages, so a tile that reads it in place
/// misses the cache at every value.
#pragma once

#include "sinew/linalg/dense_kernels.hpp"

namespace sinew::linalg {

/// Whether copying costs less than it saves, decided by the shape only. The bits are the same
/// either way, except for `subtract` with sums of more than 144 terms.
inline bool worth_packing(const Product& product, int rows) {
  return rows >= 48 && product.columns >= 48 && product.depth >= 48 &&
         (product.leading_a >= 320 || product.leading_b >= 320);
}

/// Packed version of multiply().
void multiply_packed(const Product& product, int row_begin, int row_end, double* c, long leading,
                     Store store, Part part);

}  // namespace sinew::linalg
