/// @file
/// Spreads the product of an update over the rows of its target panel.
#pragma once

#include <span>

#include "sinew/linalg/block_symbolic.hpp"

namespace sinew::linalg {

/// panel(target row of i, column_place[j / 3] + j % 3) -= product(i - begin, j) for the rows
/// begin <= i < end of an update and all columns j <= i. Entries of the target above its diagonal
/// may change too; they are not in use.
struct Spread {
  std::span<const RowRun> runs;        ///< all rows of the update
  std::span<const RowWindow> windows;  ///< the rows begin .. end-1
  const int* column_place;             ///< by node
  int columns;
  int begin, end;
  const double* product;  ///< readable up to 7 rows past the end
  long leading_product;
  double* panel;  ///< column-major
  long leading;
};

/// Does it in the way that is faster on the processor built for; see Spread.
void spread_rows(const Spread& spread);

/// By stretches of rows, on any processor.
void spread_runs(const Spread& spread);
/// By windows of eight rows, which a mask expands: AVX-512 alone.
void spread_windows(const Spread& spread);

}  // namespace sinew::linalg
