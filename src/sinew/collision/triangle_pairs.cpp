#include "sinew/collision/triangle_pairs.hpp"

#include <algorithm>
#include <array>

namespace sinew::collision {

namespace {

/// Number of pairs of branches that threads share: enough for an even load, and the same for any
/// number of threads.
constexpr std::size_t kFront = 512;
constexpr int kMaxLevels = 24;
/// A pair is replaced by at most three, and two trees have less than 64 levels together.
constexpr std::size_t kPairStack = 192;

double extent(const SurfaceTree::Branch& branch) {
  return (branch.box.high - branch.box.low).sum();
}

}  // namespace

TrianglePairs::TrianglePairs(ThreadPool& pool) : pairs_(pool) {}

std::span<const TrianglePair> TrianglePairs::between(const SurfaceTree& first,
                                                     const SurfaceTree& second, double distance) {
  return find({first, second, distance, false, nullptr});
}

std::span<const TrianglePair> TrianglePairs::within(const SurfaceTree& surface, double distance,
                                                    const NormalCones* cones) {
  return find({surface, surface, distance, true, cones});
}

// Descends from the roots until there is work for all threads.
void TrianglePairs::spread(const Search& search) {
  front_.assign(1, {0, 0});
  for (int level = 0; level < kMaxLevels && front_.size() < kFront; ++level) {
    next_.clear();
    for (const BranchPair& pair : front_) {
      if (is_leaf(search, pair)) {
        next_.push_back(pair);
      } else {
        descend(search, pair, [&](const BranchPair& child) { next_.push_back(child); });
      }
    }
    front_.swap(next_);
  }
}

std::span<const TrianglePair> TrianglePairs::find(const Search& search) {
  spread(search);
  const auto below = [&](const BranchPair& top, std::vector<TrianglePair>& found) {
    std::array<BranchPair, kPairStack> open{top};
    std::size_t count = 1;
    while (count > 0) {
      const BranchPair pair = open[--count];
      if (is_leaf(search, pair)) {
        compare(search, pair, found);
      } else {
        descend(search, pair, [&](const BranchPair& child) { open[count++] = child; });
      }
    }
  };
  return pairs_.collect(static_cast<int>(front_.size()), 1,
                        [&](int begin, int end, std::vector<TrianglePair>& found) {
                          for (int k = begin; k < end; ++k) {
                            below(front_[static_cast<std::size_t>(k)], found);
                          }
                        });
}

bool TrianglePairs::is_leaf(const Search& search, const BranchPair& pair) {
  return search.first.branches()[static_cast<std::size_t>(pair.first)].right < 0 &&
         search.second.branches()[static_cast<std::size_t>(pair.second)].right < 0;
}

template <typename Keep>
void TrianglePairs::descend(const Search& search, const BranchPair& pair, const Keep& keep_pair) {
  const auto& first = search.first.branches();
  const auto& second = search.second.branches();
  const auto& a = first[static_cast<std::size_t>(pair.first)];
  const auto& b = second[static_cast<std::size_t>(pair.second)];
  const auto keep = [&](int left, int right) {
    const auto& x = first[static_cast<std::size_t>(left)];
    const auto& y = second[static_cast<std::size_t>(right)];
    const double far = std::max(search.distance, x.motion + y.motion);
    if (x.box.is_apart(y.box, far)) return;
    if (search.cones != nullptr && search.cones->branches_are_averse(left, right)) return;
    keep_pair(BranchPair{left, right});
  };
  if (search.same && pair.first == pair.second) {
    keep(pair.first + 1, pair.first + 1);
    keep(pair.first + 1, a.right);
    keep(a.right, a.right);
  } else if (b.right < 0 || (a.right >= 0 && extent(a) >= extent(b))) {
    keep(pair.first + 1, pair.second);
    keep(a.right, pair.second);
  } else {
    keep(pair.first, pair.second + 1);
    keep(pair.first, b.right);
  }
}

void TrianglePairs::compare(const Search& search, const BranchPair& leaf,
                            std::vector<TrianglePair>& to) {
  const auto& a = search.first.branches()[static_cast<std::size_t>(leaf.first)];
  const auto& b = search.second.branches()[static_cast<std::size_t>(leaf.second)];
  const bool same = search.same && leaf.first == leaf.second;
  for (int i = a.begin; i < a.end; ++i) {
    const int left = search.first.order()[static_cast<std::size_t>(i)];
    const Box& box = search.first.box(left);
    const double motion = search.first.motion(left);
    if (box.is_apart(b.box, std::max(search.distance, motion + b.motion))) continue;
    for (int j = same ? i + 1 : b.begin; j < b.end; ++j) {
      const int right = search.second.order()[static_cast<std::size_t>(j)];
      const double far = std::max(search.distance, motion + search.second.motion(right));
      if (box.is_apart(search.second.box(right), far)) continue;
      if (search.cones != nullptr && search.cones->are_averse(left, right)) continue;
      to.push_back({left, right});
    }
  }
}

}  // namespace sinew::collision
