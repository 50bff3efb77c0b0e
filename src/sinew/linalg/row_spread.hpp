/// @file
/// Scatters the product of an update to the rows of its target panel.
#pragma once

#include <span>

#include "sinew/linalg/block_symbolic.hpp"

namespace sinew::linalg {

/// Arguments of panel(target row of i, column_place[j / 3] + j % 3) -= product(i - begin, j) for
/// the rows begin <= i < end of an update and all columns j <= i. Entries of the target above its
/// diagonal, which are unused, may change, too.
struct Spread {
  std::span<const RowRun> runs;        ///< all rows of the update
  std::span<const RowWindow> windows;  ///< the rows begin .. end-1
  const int* column_place;             ///< first target column of each node
  int columns;
  int begin, end;
  const double* product;  ///< readable up to 7 rows past the end
  long leading_product;
  double* panel;  ///< column-major
  long leading;
};

/// Performs a Spread, by the method that is faster on the target processor.
void spread_rows(const Spread& spread);

/// Performs a Spread by runs of rows; for any processor.
void spread_runs(const Spread& spread);
/// Performs a Spread by masked windows of eight rows; only with AVX-512.
void spread_windows(const Spread& spread);

}  // namespace sinew::linalg
