#include "sinew/mechanics/touched_blocks.hpp"

#include <algorithm>
#include <array>

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/mechanics/sparse_rows.hpp"

namespace sinew::mechanics {

namespace {

using Block = std::array<double, linalg::kBlockStride>;

Block columns_of(const Matrix3& k) {
  Block block{};
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) block[static_cast<std::size_t>(4 * c + r)] = k(r, c);
  }
  return block;
}

void add_to(double* to, double weight, const Block& block) {
  for (std::size_t k = 0; k < block.size(); ++k) to[k] += weight * block[k];
}

}  // namespace

void TouchedBlocks::add(const linalg::BlockPattern& pattern, int first, int second,
                        const Matrix3& hessian, std::span<double> matrix) {
  if (pattern_ != &pattern) pairs_.clear();
  pattern_ = &pattern;
  const Pair& pair = find(first, second);
  if (pair.turns) {
    for (const Target& target : pair.targets) {
      const Block block = columns_of(turn(target, first, second, hessian));
      add_to(matrix.data() + target.begin, target.weight, block);
    }
    return;
  }
  const std::array<Block, 3> turned{columns_of(hessian), columns_of(hessian.transpose()),
                                    columns_of(hessian + hessian.transpose())};
  for (const Target& target : pair.targets) {
    const Block& block = turned[static_cast<std::size_t>(target.turned)];
    add_to(matrix.data() + target.begin, target.weight, block);
  }
}

// J_a^T C J_b without the weights, as the target takes it. A turning block has
// J dq = dq x l = -[l]x dq, so J = -[l]x and J^T = [l]x.
Matrix3 TouchedBlocks::turn(const Target& target, int first, int second,
                            const Matrix3& hessian) const {
  Matrix3 block = hessian;
  if (target.first.turns) {
    block = (cross_matrix(levers_.lever(first, target.first.block)) * block).eval();
  }
  if (target.second.turns) {
    block = (block * -cross_matrix(levers_.lever(second, target.second.block))).eval();
  }
  if (target.turned == Turned::both) return block + block.transpose();
  return target.turned == Turned::yes ? Matrix3(block.transpose()) : block;
}

const TouchedBlocks::Pair& TouchedBlocks::find(int first, int second) {
  const auto own = static_cast<std::size_t>(first);
  if (own >= pairs_.size()) pairs_.resize(own + 1);
  const auto found = std::ranges::find(pairs_[own], second, &Pair::second);
  if (found != pairs_[own].end()) return *found;
  return pairs_[own].emplace_back(reach(first, second));
}

// Only the lower triangle is stored. Of a site with itself, C is symmetric.
TouchedBlocks::Pair TouchedBlocks::reach(int first, int second) const {
  Pair pair{second, false, {}};
  for (const SiteBlock& a : sites_[first]) {
    for (const SiteBlock& b : sites_[second]) {
      const std::int32_t i = a.block, j = b.block;
      if (first == second && i < j) continue;
      const int block = pattern_->find(i, j);
      if (block < 0) {
        throw Error(ErrorKind::internal, {}, "a pair of points is not in the pattern",
                    "declare the coupling when the model is made");
      }
      const Turned turned = first != second && i == j ? Turned::both
                            : i < j                   ? Turned::yes
                                                      : Turned::no;
      pair.turns = pair.turns || a.turns || b.turns;
      pair.targets.push_back({linalg::kBlockStride * static_cast<std::int64_t>(block),
                              -a.weight * b.weight, turned, a, b});
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

}  // namespace sinew::mechanics
