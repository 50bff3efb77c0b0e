#include "sinew/fem/rounding_floor.hpp"

#include <cmath>
#include <limits>

#include "sinew/core/types.hpp"

namespace sinew::fem {

// Rounding of the positions changes the i-th force by eps X sum_j |A_ij|, where X is the largest
// coordinate of the body. Elements evaluate their forces with errors of a few eps |K_e| |x_e|, and
// inertia M (x - x_start)/h^2 has errors of eps M/h^2 |x|. Both are within this bound, since A
// contains K and M/h^2.
double rounding_floor(const linalg::BlockPattern& pattern, std::span<const double> matrix,
                      std::span<const std::int32_t> held, double largest, VectorX& sum) {
  sum.setZero(3 * static_cast<Eigen::Index>(pattern.nodes));
  for (std::int32_t j = 0; j < pattern.nodes; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (auto b = pattern.column_start[column]; b < pattern.column_start[column + 1]; ++b) {
      const std::int32_t i = pattern.row[static_cast<std::size_t>(b)];
      const double* block = matrix.data() + linalg::kBlockStride * static_cast<std::size_t>(b);
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
          const double size = std::abs(block[4 * c + r]);
          sum[3 * i + r] += size;
          if (i != j) sum[3 * j + c] += size;
        }
      }
    }
  }
  for (const std::int32_t coordinate : held) sum[coordinate] = 0.0;
  return std::numeric_limits<double>::epsilon() * largest * sum.norm();
}

}  // namespace sinew::fem
