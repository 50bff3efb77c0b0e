#include "sinew/fem/open_pressure.hpp"

#include <vector>

#include "sinew/linalg/dense.hpp"
#include "sinew/linalg/factorisation.hpp"

namespace sinew::fem {

namespace {

constexpr int kMaxDirections = 60;  // of GMRES
constexpr double kTolerance = 1e-12;

void multiply(std::span<const FreeBlock> blocks, std::span<const std::int32_t> held,
              const VectorX& x, VectorX& y) {
  y.setZero(x.size());
  for (const auto& [row, column, block] : blocks) {
    y.segment<3>(3 * row) += block * x.segment<3>(3 * column);
  }
  for (const std::int32_t coordinate : held) y[coordinate] = 0.0;
}

}  // namespace

// (I + A^-1 B) dq = A^-1 r by GMRES (Saad & Schultz 1986), which needs as many directions as the
// rim of the surface makes B's rank, at most.
void correct_for_open_pressure(std::span<const FreeBlock> blocks,
                               std::span<const std::int32_t> held, linalg::Factorisation& factor,
                               VectorX& motion) {
  const double size = motion.norm();
  if (!(size > 0.0)) return;
  std::vector<VectorX> basis{motion / size};
  MatrixX hessenberg = MatrixX::Zero(kMaxDirections + 1, kMaxDirections);
  VectorX weights;
  VectorX product;
  for (int k = 0; k < kMaxDirections; ++k) {
    multiply(blocks, held, basis.back(), product);
    const std::span<double> solved(product.data(), static_cast<std::size_t>(product.size()));
    factor.solve(solved, solved);
    product += basis.back();
    for (int j = 0; j <= k; ++j) {
      hessenberg(j, k) = basis[static_cast<std::size_t>(j)].dot(product);
      product -= hessenberg(j, k) * basis[static_cast<std::size_t>(j)];
    }
    hessenberg(k + 1, k) = product.norm();
    VectorX right = VectorX::Zero(k + 2);
    right[0] = size;
    const MatrixX part = hessenberg.topLeftCorner(k + 2, k + 1);
    weights = linalg::least_squares(part, right).x;
    const bool done = (part * weights - right).norm() <= kTolerance * size;
    if (done || !(hessenberg(k + 1, k) > kTolerance * part.norm())) break;
    basis.push_back(product / hessenberg(k + 1, k));
  }
  motion.setZero();
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    motion += weights[k] * basis[static_cast<std::size_t>(k)];
  }
}

}  // namespace sinew::fem
