#include "sinew/linalg/row_spread.hpp"

namespace sinew::linalg {

void spread_rows(const Spread& spread) {
#if defined(__AVX512F__)
  spread_windows(spread);
#else
  spread_runs(spread);
#endif
}

}  // namespace sinew::linalg
