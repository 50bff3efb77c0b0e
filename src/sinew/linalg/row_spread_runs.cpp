#include <algorithm>

#include "sinew/linalg/row_spread.hpp"
#include "sinew/linalg/vector_lanes.hpp"

namespace sinew::linalg {

namespace {

/// Subtracts three columns of `count` rows, a multiple of 3. Writes exactly these rows, since a
/// vector write beyond the end would stall the next read of the following rows.
inline void subtract_columns(double* target, long leading, const double* source,
                             long leading_source, int count) {
  for (int c = 0; c < 3; ++c, target += leading, source += leading_source) {
    int i = 0;
    for (; i + kLanes <= count; i += kLanes) {
      store(target + i, load(target + i) - load(source + i));
    }
    for (; i < count; ++i) target[i] -= source[i];
  }
}

}  // namespace

void spread_runs(const Spread& s) {
  for (const RowRun& run : s.runs) {
    const int first = std::max(run.source, s.begin);
    const int last = std::min(run.source + run.length, s.end);
    if (first >= last) continue;
    const double* const source = s.product - s.begin;
    double* const target = s.panel + (run.target - run.source);
    for (int j = 0; j < s.columns && j < last; j += 3) {
      const int row = std::max(first, j);
      subtract_columns(target + row + s.column_place[j / 3] * s.leading, s.leading,
                       source + row + j * s.leading_product, s.leading_product, last - row);
    }
  }
}

}  // namespace sinew::linalg
