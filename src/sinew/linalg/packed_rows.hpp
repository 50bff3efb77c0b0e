/// @file
/// Substitution of many rows with one diagonal block, with operands copied as in
/// packed_product.hpp.
#pragma once

#include "sinew/linalg/dense_kernels.hpp"

namespace sinew::linalg {

/// The maximum width of a block.
inline constexpr int kMaxPackedBlock = 144;

/// Whether copying costs less than it saves, decided by the shape only. The bits are the same
/// either way.
inline bool worth_packing(const DiagonalBlock& block, int rows) {
  return rows >= 48 && block.columns >= 48 && block.columns <= kMaxPackedBlock;
}

/// Packed version of solve_rows_apart().
void solve_rows_packed(const DiagonalBlock& block, double* rows, long leading, int count);

}  // namespace sinew::linalg
