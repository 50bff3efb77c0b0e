#include "sinew/linalg/block_product.hpp"

#include <algorithm>
#include <cstddef>

namespace sinew::linalg {

void multiply(const BlockPattern& pattern, std::span<const double> matrix,
              std::span<const double> x, std::span<double> y) {
  std::ranges::fill(y, 0.0);
  for (int j = 0; j < pattern.nodes; ++j) {
    const auto column = static_cast<std::size_t>(j);
    const double* xj = x.data() + 3 * column;
    double* yj = y.data() + 3 * column;
    for (auto b = pattern.column_start[column]; b < pattern.column_start[column + 1]; ++b) {
      const auto row = static_cast<std::size_t>(pattern.row[static_cast<std::size_t>(b)]);
      const double* block =
          matrix.data() + static_cast<std::size_t>(kBlockStride) * static_cast<std::size_t>(b);
      const double* xi = x.data() + 3 * row;
      double* yi = y.data() + 3 * row;
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) yi[r] += block[4 * c + r] * xj[c];
      }
      if (row == column) continue;
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) yj[c] += block[4 * c + r] * xi[r];
      }
    }
  }
}

}  // namespace sinew::linalg
