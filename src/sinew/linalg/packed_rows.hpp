/// @file
/// Substitution of many rows with one diagonal block, with copies as in packed_product.hpp.
#pragma once

#include "sinew/linalg/dense_kernels.hpp"

namespace sinew::linalg {

/// The widest block that it takes.
inline constexpr int kMaxPackedBlock = 144;

/// Whether copies cost less than they save. By the shape alone; the bits are the same either way.
inline bool worth_packing(const DiagonalBlock& block, int rows) {
  return rows >= 48 && block.columns >= 48 && block.columns <= kMaxPackedBlock;
}

/// As solve_rows_apart().
void solve_rows_packed(const DiagonalBlock& block, double* rows, long leading, int count);

}  // namespace sinew::linalg
