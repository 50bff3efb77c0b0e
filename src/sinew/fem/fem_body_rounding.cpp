// What rounding leaves of a FemBody's residual.
#include <cmath>
#include <limits>

#include "sinew/fem/fem_body.hpp"
#include "sinew/fem/fem_body_numbers.hpp"

namespace sinew::fem {

// The i-th force is known to eps X sum_j |A_ij|, X the largest coordinate of the body: that is what
// a rounding of the positions changes it by. Elements evaluate their forces with errors of a few
// eps |K_e| |x_e|, and inertia M (x - x_start)/h^2 with eps M/h^2 |x|: both are within it, since A
// holds K and M/h^2.
double FemBody::rounding_floor() const {
  const linalg::BlockPattern& pattern = active_->system.elements->pattern();
  const std::span<const double> matrix = active_->assembly.matrix();
  VectorX sum = VectorX::Zero(right_.size());
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
  for (const std::int32_t held : model_.elements().held()) sum[held] = 0.0;
  return std::numeric_limits<double>::epsilon() * positions_.cwiseAbs().maxCoeff() * sum.norm();
}

}  // namespace sinew::fem
