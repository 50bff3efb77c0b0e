#include "sinew/linalg/block_pattern.hpp"

#include <algorithm>
#include <string>

#include "sinew/core/error.hpp"
#include "sinew/linalg/index.hpp"

namespace sinew::linalg {

namespace {

void check_cliques(int nodes, std::span<const Index> starts, std::span<const Index> members) {
  const auto fail = [](const std::string& message) {
    throw Error(ErrorKind::index_out_of_range, Location{.file = {}, .item = "block pattern"},
                message, "give node numbers from 0 to nodes - 1 and ascending starts");
  };
  if (nodes < 0) fail("the number of nodes is " + std::to_string(nodes));
  if (!starts.empty() && (starts.front() != 0 || !std::is_sorted(starts.begin(), starts.end()) ||
                          starts.back() != static_cast<Index>(members.size()))) {
    fail("the clique starts do not split the " + std::to_string(members.size()) + " members");
  }
  for (const Index member : members) {
    if (member < 0 || member >= nodes) {
      fail("node " + std::to_string(member) + " of " + std::to_string(nodes));
    }
  }
}

/// For every node, the cliques that contain it: (starts, cliques).
std::pair<std::vector<Index>, std::vector<Index>> cliques_of_nodes(int nodes,
                                                                   std::span<const Index> starts,
                                                                   std::span<const Index> members) {
  std::vector<Index> begin(static_cast<std::size_t>(nodes) + 1, 0);
  for (const Index member : members) ++begin[static_cast<std::size_t>(member) + 1];
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  std::vector<Index> clique(members.size());
  for (std::size_t c = 0; c + 1 < starts.size(); ++c) {
    for (Index e = starts[c]; e < starts[c + 1]; ++e) {
      const auto node = static_cast<std::size_t>(members[static_cast<std::size_t>(e)]);
      clique[static_cast<std::size_t>(next[node]++)] = static_cast<Index>(c);
    }
  }
  return {std::move(begin), std::move(clique)};
}

}  // namespace

int BlockPattern::find(int i, int j) const {
  const auto [low, high] = std::minmax(i, j);
  if (low < 0 || high >= nodes) return -1;
  const auto first = row.begin() + column_start[static_cast<std::size_t>(low)];
  const auto last = row.begin() + column_start[static_cast<std::size_t>(low) + 1];
  const auto found = std::lower_bound(first, last, high);
  if (found == last || *found != high) return -1;
  return static_cast<int>(found - row.begin());
}

BlockPattern BlockPattern::from_cliques(int nodes, std::span<const std::int32_t> starts,
                                        std::span<const std::int32_t> members) {
  check_cliques(nodes, starts, members);
  const auto [begin, clique] = cliques_of_nodes(nodes, starts, members);
  BlockPattern pattern;
  pattern.nodes = nodes;
  pattern.column_start.reserve(static_cast<std::size_t>(nodes) + 1);
  std::vector<Index> seen_by(static_cast<std::size_t>(nodes), -1);
  for (Index j = 0; j < nodes; ++j) {
    const auto first = static_cast<std::ptrdiff_t>(pattern.row.size());
    pattern.row.push_back(j);
    seen_by[static_cast<std::size_t>(j)] = j;
    for (Index c = begin[static_cast<std::size_t>(j)]; c < begin[static_cast<std::size_t>(j) + 1];
         ++c) {
      const auto k = static_cast<std::size_t>(clique[static_cast<std::size_t>(c)]);
      for (Index e = starts[k]; e < starts[k + 1]; ++e) {
        const Index i = members[static_cast<std::size_t>(e)];
        if (i <= j || seen_by[static_cast<std::size_t>(i)] == j) continue;
        seen_by[static_cast<std::size_t>(i)] = j;
        pattern.row.push_back(i);
      }
    }
    std::sort(pattern.row.begin() + first, pattern.row.end());
    pattern.column_start.push_back(static_cast<Index>(pattern.row.size()));
  }
  return pattern;
}

}  // namespace sinew::linalg
