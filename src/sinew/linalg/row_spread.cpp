#include "sinew/linalg/row_spread.hpp"

#include <algorithm>

#include "sinew/linalg/vector_lanes.hpp"

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace sinew::linalg {

#if defined(__AVX512F__)

// Whole vectors of the target are rewritten, rows without a source with what they hold. Every write
// covers the same eight rows as the reads that follow it, so none of them waits for the other.
void spread_rows(const Spread& s) {
  const RowWindow* first = s.windows.data();
  const RowWindow* const last = first + s.windows.size();
  for (int j = 0; j < s.columns && j < s.end; j += 3) {
    while (first + 1 != last && (first + 1)->source <= j) ++first;  // rows above the diagonal
    double* const target = s.panel + s.column_place[j / 3] * s.leading;
    const double* const source = s.product - s.begin + j * s.leading_product;
    for (const RowWindow* window = first; window != last; ++window) {
      SINEW_UNROLL for (int c = 0; c < 3; ++c) {
        double* const to = target + window->target + c * s.leading;
        const __m512d x = _mm512_loadu_pd(source + window->source + c * s.leading_product);
        const __m512d y = _mm512_maskz_expand_pd(window->mask, x);
        _mm512_storeu_pd(to, _mm512_sub_pd(_mm512_loadu_pd(to), y));
      }
    }
  }
}

#else

namespace {

/// Three columns of `count` rows, a multiple of 3. Writes exactly these rows: a vector that ran
/// over the end would hold up the next read of the rows behind.
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

void spread_rows(const Spread& s) {
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

#endif

}  // namespace sinew::linalg
