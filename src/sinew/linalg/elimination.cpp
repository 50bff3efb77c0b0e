#include "sinew/linalg/elimination.hpp"

#include <algorithm>
#include <mutex>
#include <numeric>
#include <string>

#include <amd.h>
#include <metis.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/index.hpp"

namespace sinew::linalg {

namespace {

static_assert(sizeof(idx_t) == sizeof(Index), "METIS must be built with 32-bit indices");

[[noreturn]] void fail(const std::string& library, int status) {
  throw Error(ErrorKind::internal, Location{.file = {}, .item = "matrix ordering"},
              library + " returned status " + std::to_string(status), {});
}

std::vector<Index> amd(const NodeGraph& graph) {
  std::vector<Index> order(at(graph.nodes()));
  const int status = amd_order(graph.nodes(), graph.start.data(), graph.neighbour.data(),
                               order.data(), nullptr, nullptr);
  if (status != AMD_OK && status != AMD_OK_BUT_JUMBLED) fail("AMD", status);
  return order;
}

std::vector<Index> metis(const NodeGraph& graph) {
  idx_t nodes = graph.nodes();
  std::vector<Index> start = graph.start;  // METIS takes non-const arguments
  std::vector<Index> neighbour = graph.neighbour;
  std::vector<Index> order(at(nodes));
  std::vector<Index> inverse(at(nodes));
  std::vector<idx_t> options(METIS_NOPTIONS);
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  // METIS seeds and uses the global rand() of the C library. Concurrent orderings would take each
  // other's numbers and differ in every run.
  static std::mutex one_at_a_time;
  const std::scoped_lock lock(one_at_a_time);
  const int status = METIS_NodeND(&nodes, start.data(), neighbour.data(), nullptr, options.data(),
                                  order.data(), inverse.data());
  if (status != METIS_OK) fail("METIS", status);
  return order;
}

std::vector<Index> inverse_of(const std::vector<Index>& order) {
  std::vector<Index> position(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) position[at(order[k])] = static_cast<Index>(k);
  return position;
}

/// Liu's algorithm with path compression.
std::vector<Index> elimination_tree(const NodeGraph& graph, const std::vector<Index>& order) {
  const std::vector<Index> position = inverse_of(order);
  std::vector<Index> parent(order.size(), -1);
  std::vector<Index> ancestor(order.size(), -1);
  for (Index k = 0; k < graph.nodes(); ++k) {
    const std::size_t node = at(order[at(k)]);
    for (Index e = graph.start[node]; e < graph.start[node + 1]; ++e) {
      Index i = position[at(graph.neighbour[at(e)])];
      while (i != -1 && i < k) {
        const Index next = ancestor[at(i)];
        ancestor[at(i)] = k;
        if (next == -1) parent[at(i)] = k;
        i = next;
      }
    }
  }
  return parent;
}

}  // namespace

NodeGraph::NodeGraph(const BlockPattern& pattern) {
  std::vector<Index> degree(at(pattern.nodes) + 1, 0);
  const auto for_each_pair = [&pattern](auto&& visit) {
    for (Index j = 0; j < pattern.nodes; ++j) {
      for (Index b = pattern.column_start[at(j)]; b < pattern.column_start[at(j) + 1]; ++b) {
        if (pattern.row[at(b)] != j) visit(pattern.row[at(b)], j);
      }
    }
  };
  for_each_pair([&degree](Index i, Index j) {
    ++degree[at(i) + 1];
    ++degree[at(j) + 1];
  });
  std::partial_sum(degree.begin(), degree.end(), degree.begin());
  start = degree;
  neighbour.resize(at(start.back()));
  for_each_pair([&](Index i, Index j) {
    neighbour[at(degree[at(i)]++)] = j;
    neighbour[at(degree[at(j)]++)] = i;
  });
}

std::vector<std::int32_t> fill_reducing_order(const NodeGraph& graph, Ordering which) {
  if (graph.neighbour.empty()) {  // no fill, and METIS rejects an empty graph
    std::vector<Index> order(at(graph.nodes()));
    std::iota(order.begin(), order.end(), 0);
    return order;
  }
  return which == Ordering::metis ? metis(graph) : amd(graph);
}

std::vector<std::int32_t> postorder(const std::vector<std::int32_t>& parent) {
  const std::size_t count = parent.size();
  std::vector<Index> child(count, -1);
  std::vector<Index> sibling(count, -1);
  std::vector<Index> stack;
  for (std::size_t k = count; k-- > 0;) {
    if (parent[k] < 0) {
      stack.push_back(static_cast<Index>(k));
    } else {
      sibling[k] = child[at(parent[k])];
      child[at(parent[k])] = static_cast<Index>(k);
    }
  }
  std::vector<Index> result;
  result.reserve(count);
  while (!stack.empty()) {
    const Index k = stack.back();
    if (child[at(k)] >= 0) {
      const Index next = child[at(k)];
      child[at(k)] = sibling[at(next)];
      stack.push_back(next);
    } else {
      stack.pop_back();
      result.push_back(k);
    }
  }
  return result;
}

Elimination::Elimination(const NodeGraph& graph, const std::vector<std::int32_t>& first_order,
                         const std::vector<std::vector<std::int32_t>>& border_of) {
  const int nodes = graph.nodes();
  const std::vector<Index> first_parent = elimination_tree(graph, first_order);
  const std::vector<Index> post = postorder(first_parent);
  const std::vector<Index> renumbered = inverse_of(post);
  order.resize(at(nodes));
  parent.resize(at(nodes));
  for (Index k = 0; k < nodes; ++k) {
    const Index old = post[at(k)];
    order[at(k)] = first_order[at(old)];
    parent[at(k)] = first_parent[at(old)] < 0 ? -1 : renumbered[at(first_parent[at(old)])];
  }
  const std::vector<Index> position = inverse_of(order);
  rows.resize(at(nodes));
  for (Index k = 0; k < nodes; ++k) {
    std::vector<Index>& mine = rows[at(k)];  // has the rows of the children, with repetitions
    const std::size_t node = at(order[at(k)]);
    for (Index e = graph.start[node]; e < graph.start[node + 1]; ++e) {
      const Index i = position[at(graph.neighbour[at(e)])];
      if (i > k) mine.push_back(i);
    }
    for (const Index g : border_of[node]) mine.push_back(nodes + g);
    std::sort(mine.begin(), mine.end());
    mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
    if (parent[at(k)] >= 0) {
      std::vector<Index>& above = rows[at(parent[at(k)])];
      for (const Index i : mine) {
        if (i != parent[at(k)]) above.push_back(i);
      }
    }
  }
}

}  // namespace sinew::linalg
