#include "sinew/fem/touched_blocks.hpp"

#include <algorithm>
#include <array>

#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/linalg/block_pattern.hpp"

namespace sinew::fem {

namespace {

using Block = std::array<double, linalg::kBlockStride>;

Block columns_of(const Matrix3& k) {
  Block block{};
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) block[static_cast<std::size_t>(4 * c + r)] = k(r, c);
  }
  return block;
}

}  // namespace

void TouchedBlocks::add(const FemSystem& system, int first, int second, const Matrix3& hessian,
                        std::span<double> matrix) {
  if (system_ != &system) pairs_.clear();
  system_ = &system;
  const std::array<Block, 3> turned{columns_of(hessian), columns_of(hessian.transpose()),
                                    columns_of(hessian + hessian.transpose())};
  for (const Target& target : find(first, second).targets) {
    const Block& block = turned[static_cast<std::size_t>(target.turned)];
    double* to = matrix.data() + target.begin;
    for (std::size_t k = 0; k < block.size(); ++k) to[k] += target.weight * block[k];
  }
}

const TouchedBlocks::Pair& TouchedBlocks::find(int first, int second) {
  const auto own = static_cast<std::size_t>(first);
  if (own >= pairs_.size()) pairs_.resize(own + 1);
  const auto found = std::ranges::find(pairs_[own], second, &Pair::second);
  if (found != pairs_[own].end()) return *found;
  return pairs_[own].emplace_back(reach(first, second));
}

// Only the lower triangle is stored. Of a point with itself, C is symmetric.
TouchedBlocks::Pair TouchedBlocks::reach(int first, int second) const {
  const auto free = model_.elements().free_index();
  const mechanics::Attachment &from = model_.attachment(first), &to = model_.attachment(second);
  Pair pair{second, {}};
  for (std::size_t a = 0; a < from.nodes.size(); ++a) {
    const auto i = free[static_cast<std::size_t>(from.nodes[a])];
    if (i < 0) continue;
    for (std::size_t b = 0; b < to.nodes.size(); ++b) {
      const auto j = free[static_cast<std::size_t>(to.nodes[b])];
      if (j < 0 || (first == second && i < j)) continue;
      const int block = system_->elements->pattern().find(i, j);
      if (block < 0) {
        throw Error(ErrorKind::internal, {}, "a pair of points is not in the pattern",
                    "declare the coupling when the model is made");
      }
      const Turned turned = first != second && i == j ? Turned::both
                            : i < j                   ? Turned::yes
                                                      : Turned::no;
      pair.targets.push_back({linalg::kBlockStride * static_cast<std::int64_t>(block),
                              -from.weights[a] * to.weights[b], turned});
    }
  }
  return pair;
}

std::size_t TouchedBlocks::bytes() const {
  std::size_t total = pairs_.capacity() * sizeof(std::vector<Pair>);
  for (const auto& own : pairs_) {
    total += own.capacity() * sizeof(Pair);
    for (const Pair& pair : own) total += pair.targets.capacity() * sizeof(Target);
  }
  return total;
}

}  // namespace sinew::fem
