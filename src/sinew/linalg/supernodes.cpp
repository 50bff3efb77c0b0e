#include "sinew/linalg/supernodes.hpp"

#include <algorithm>

#include "sinew/linalg/index.hpp"

namespace sinew::linalg {

namespace {

/// A set of columns that becomes a supernode.
struct Group {
  std::vector<Index> columns;  // ascending
  std::vector<Index> children;
  Index parent = -1;
  Index rows = 0;  // node rows below the last column
  Index width() const { return static_cast<Index>(columns.size()); }
};

/// Fundamental supernodes: chains of the tree whose columns have the same rows.
std::vector<Group> fundamental_groups(const Elimination& tree) {
  std::vector<Group> groups;
  std::vector<Index> group_of(tree.order.size());
  for (std::size_t k = 0; k < tree.order.size(); ++k) {
    const bool extends = k > 0 && tree.parent[k - 1] == static_cast<Index>(k) &&
                         tree.rows[k - 1].size() == tree.rows[k].size() + 1;
    if (!extends) groups.emplace_back();
    groups.back().columns.push_back(static_cast<Index>(k));
    groups.back().rows = static_cast<Index>(tree.rows[k].size());
    group_of[k] = static_cast<Index>(groups.size()) - 1;
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Index above = tree.parent[at(groups[g].columns.back())];
    if (above < 0) continue;
    groups[g].parent = group_of[at(above)];
    groups[at(groups[g].parent)].children.push_back(static_cast<Index>(g));
  }
  return groups;
}

/// Number of zero blocks stored if `child` is merged with `parent`. The rows of the child are a
/// subset of the columns and rows of the parent.
std::int64_t added_zeros(const Group& child, const Group& parent) {
  return std::int64_t{child.width()} * (parent.width() + parent.rows - child.rows);
}

bool worth_joining(const Group& child, const Group& parent, const SupernodeSettings& settings) {
  const std::int64_t zeros = added_zeros(child, parent);
  const std::int64_t width = child.width() + parent.width();
  const std::int64_t size = width * (width + 1) / 2 + width * parent.rows;
  return zeros <= settings.zero_blocks ||
         static_cast<double>(zeros) <= settings.zero_fraction * static_cast<double>(size);
}

/// Merges children with parents, cheapest first, from the leaves up. Merged children become empty.
void join_groups(std::vector<Group>& groups, const SupernodeSettings& settings) {
  for (std::size_t p = 0; p < groups.size(); ++p) {
    Group& parent = groups[p];
    while (!parent.children.empty()) {
      const auto cheapest =
          std::min_element(parent.children.begin(), parent.children.end(), [&](Index a, Index b) {
            return added_zeros(groups[at(a)], parent) < added_zeros(groups[at(b)], parent);
          });
      Group& child = groups[at(*cheapest)];
      if (!worth_joining(child, parent, settings)) break;
      parent.children.erase(cheapest);
      parent.children.insert(parent.children.end(), child.children.begin(), child.children.end());
      for (const Index g : child.children) groups[at(g)].parent = static_cast<Index>(p);
      std::vector<Index> columns(child.columns.size() + parent.columns.size());
      std::merge(child.columns.begin(), child.columns.end(), parent.columns.begin(),
                 parent.columns.end(), columns.begin());
      parent.columns = std::move(columns);
      child = Group{};
    }
  }
}

/// Splits a number of columns into equal parts of at most `max_width`.
std::vector<Index> split_width(Index width, Index max_width) {
  const Index parts = (width + max_width - 1) / max_width;
  std::vector<Index> widths(at(parts));
  for (Index p = 0; p < parts; ++p) {
    widths[at(p)] = width * (p + 1) / parts - width * p / parts;
  }
  return widths;
}

}  // namespace

SupernodePartition::SupernodePartition(const Elimination& elimination,
                                       const SupernodeSettings& settings) {
  std::vector<Group> groups = fundamental_groups(elimination);
  join_groups(groups, settings);
  std::vector<Index> parents(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) parents[g] = groups[g].parent;
  const auto nodes = static_cast<Index>(elimination.order.size());
  std::vector<Index> renumbered(at(nodes));
  std::vector<Index> sequence;  // groups in their final order, without empty ones
  for (const Index g : postorder(parents)) {
    if (groups[at(g)].columns.empty()) continue;
    sequence.push_back(g);
    for (const Index k : groups[at(g)].columns) {
      renumbered[at(k)] = static_cast<Index>(order.size());
      order.push_back(elimination.order[at(k)]);
    }
  }
  start.push_back(0);
  for (const Index g : sequence) {
    std::vector<Index> below = elimination.rows[at(groups[at(g)].columns.back())];
    for (Index& i : below) i = i < nodes ? renumbered[at(i)] : i;
    std::sort(below.begin(), below.end());
    const Index end = start.back() + groups[at(g)].width();
    for (const Index width : split_width(groups[at(g)].width(), settings.max_width)) {
      start.push_back(start.back() + width);
      rows.emplace_back();
      for (Index i = start.back(); i < end; ++i) rows.back().push_back(i);
      rows.back().insert(rows.back().end(), below.begin(), below.end());
    }
  }
}

}  // namespace sinew::linalg
