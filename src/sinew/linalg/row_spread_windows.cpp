#include "sinew/linalg/row_spread.hpp"
#include "sinew/linalg/vector_lanes.hpp"

#if defined(__AVX512F__)
#include <immintrin.h>

namespace sinew::linalg {

// Rewrites whole vectors of the target; rows without a source keep their values. Every write covers
// the same eight rows as the following reads, so they do not stall.
void spread_windows(const Spread& s) {
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

}  // namespace sinew::linalg

#endif
