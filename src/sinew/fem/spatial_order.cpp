#include "sinew/fem/spatial_order.hpp"

#include <algorithm>
#include <numeric>

#include "sinew/core/whole.hpp"

namespace sinew::fem {

namespace {

constexpr int kBits = 20;  // per axis

/// The bits of x, with two zeros between consecutive bits.
std::uint64_t spread(std::uint64_t x) {
  std::uint64_t result = 0;
  for (int bit = 0; bit < kBits; ++bit) result |= (x >> bit & 1U) << (3 * bit);
  return result;
}

}  // namespace

std::vector<std::int32_t> spatial_ranks(const Points& nodes) {
  const auto count = static_cast<std::size_t>(nodes.rows());
  const Eigen::RowVector3d low = nodes.colwise().minCoeff();
  const double size = (nodes.colwise().maxCoeff() - low).maxCoeff();
  const double scale = size > 0.0 ? ((1 << kBits) - 1) / size : 0.0;
  std::vector<std::uint64_t> key(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) {
      const double place = (nodes(static_cast<Eigen::Index>(i), c) - low[c]) * scale;
      key[i] |= spread(whole<std::uint64_t>(place, 0, (1U << kBits) - 1)) << c;
    }
  }
  std::vector<std::int32_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {},
                           [&](std::int32_t i) { return key[static_cast<std::size_t>(i)]; });
  std::vector<std::int32_t> rank(count);
  for (std::size_t k = 0; k < count; ++k) {
    rank[static_cast<std::size_t>(order[k])] = static_cast<std::int32_t>(k);
  }
  return rank;
}

}  // namespace sinew::fem
