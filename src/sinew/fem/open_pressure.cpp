#include "sinew/fem/open_pressure.hpp"

#include "sinew/linalg/factorisation.hpp"
#include "sinew/linalg/gmres.hpp"

namespace sinew::fem {

namespace {

constexpr int kMaxDirections = 60;
constexpr double kTolerance = 1e-12;

void multiply(std::span<const FreeBlock> blocks, std::span<const std::int32_t> held,
              bool transposed, const Eigen::Ref<const VectorX>& x, Eigen::Ref<VectorX> y) {
  y.setZero();
  for (const auto& [row, column, block] : blocks) {
    if (transposed) {
      y.segment<3>(3 * column) += block.transpose() * x.segment<3>(3 * row);
    } else {
      y.segment<3>(3 * row) += block * x.segment<3>(3 * column);
    }
  }
  for (const std::int32_t coordinate : held) y[coordinate] = 0.0;
}

}  // namespace

// Solves (I + A^-1 B) dq = A^-1 r, with A symmetric; or with B^T. The number of directions needed
// is at most the rank of B plus one, and the rim of the surface determines that rank.
void correct_for_open_pressure(std::span<const FreeBlock> blocks,
                               std::span<const std::int32_t> held, linalg::Factorisation& factor,
                               VectorX& motion, bool transposed) {
  const auto multiply_with = [&](const Eigen::Ref<const VectorX>& x, Eigen::Ref<VectorX> y) {
    multiply(blocks, held, transposed, x, y);
    const std::span<double> solved(y.data(), static_cast<std::size_t>(y.size()));
    factor.solve(solved, solved);
    y += x;
  };
  linalg::Gmres(kMaxDirections, kTolerance).solve(multiply_with, motion);
}

}  // namespace sinew::fem
