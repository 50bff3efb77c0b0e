#include "sinew/collision/surface_topology.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::collision {

namespace {

// Sine of an angle at rounding level.
constexpr double kFlat = 1e-9;

}  // namespace

NumberLists::NumberLists(int count, std::span<const int> owners, std::span<const int> entries)
    : begin_(static_cast<std::size_t>(count) + 1, 0), entries_(entries.size()) {
  for (const int owner : owners) ++begin_[static_cast<std::size_t>(owner) + 1];
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const int place = next[static_cast<std::size_t>(owners[k])]++;
    entries_[static_cast<std::size_t>(place)] = entries[k];
  }
}

SurfaceTopology::SurfaceTopology(std::vector<Triangle> triangles, int node_count)
    : triangles_(std::move(triangles)), node_count_(node_count) {
  check();
  number_edges();
  list_neighbours();
}

SurfaceTopology SurfaceTopology::of_rigid(std::vector<Triangle> triangles, const Points& nodes) {
  SurfaceTopology result(std::move(triangles), static_cast<int>(nodes.rows()));
  const auto at = [&](NodeId node) -> Vector3 { return nodes.row(node).transpose(); };
  result.flat_.assign(result.edges_.size(), 0);
  for (std::size_t e = 0; e < result.edges_.size(); ++e) {
    const auto faces = result.edge_triangles_[static_cast<int>(e)];
    if (faces.size() != 2) continue;
    const Triangle& own = result.triangles_[static_cast<std::size_t>(faces[0])];
    const Vector3 corner = at(own[0]);
    const Vector3 normal = (at(own[1]) - corner).cross(at(own[2]) - corner).normalized();
    double lowest = 0.0;  // height of the other triangle over the first one's plane
    double farthest = 0.0;
    for (const NodeId node : result.triangles_[static_cast<std::size_t>(faces[1])]) {
      lowest = std::min(lowest, normal.dot(at(node) - corner));
      farthest = std::max(farthest, (at(node) - corner).norm());
    }
    result.flat_[e] = lowest >= -kFlat * farthest ? 1 : 0;
  }
  return result;
}

void SurfaceTopology::check() const {
  if (triangles_.empty()) {
    throw Error(ErrorKind::empty_region, {.item = "triangles"}, "the surface has no triangles");
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    for (const NodeId node : triangles_[t]) {
      if (node >= 0 && node < node_count_) continue;
      throw Error(ErrorKind::index_out_of_range, {.item = "triangles"},
                  fmt::format("triangle {} has node {}, and there are {}", t, node, node_count_));
    }
    if (a == b || b == c || c == a) {
      throw Error(ErrorKind::repeated_node_in_element, {.item = "triangles"},
                  fmt::format("triangle {} has the nodes {}, {}, {}", t, a, b, c));
    }
  }
}

void SurfaceTopology::number_edges() {
  std::map<Edge, int> number;
  std::vector<int> balance;  // number of passes along an edge minus those back
  std::vector<int> owners, entries;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    auto& own = triangle_edges_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const NodeId from = triangles_[t][k], to = triangles_[t][(k + 1) % 3];
      const Edge edge{std::min(from, to), std::max(from, to)};
      const auto [place, is_new] = number.try_emplace(edge, static_cast<int>(edges_.size()));
      if (is_new) {
        edges_.push_back(edge);
        balance.push_back(0);
      }
      own[k] = place->second;
      balance[static_cast<std::size_t>(own[k])] += from < to ? 1 : -1;
      owners.push_back(own[k]);
      entries.push_back(static_cast<int>(t));
    }
  }
  edge_triangles_ = NumberLists(static_cast<int>(edges_.size()), owners, entries);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    closed_ = closed_ && balance[e] == 0 && edge_triangles_[static_cast<int>(e)].size() == 2;
  }
}

void SurfaceTopology::list_neighbours() {
  std::vector<int> nodes, their_triangles, ends, their_edges;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (const NodeId node : triangles_[t]) {
      nodes.push_back(node);
      their_triangles.push_back(static_cast<int>(t));
    }
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    for (const NodeId node : edges_[e]) {
      ends.push_back(node);
      their_edges.push_back(static_cast<int>(e));
    }
  }
  node_triangles_ = NumberLists(node_count_, nodes, their_triangles);
  node_edges_ = NumberLists(node_count_, ends, their_edges);

  const auto owned = [&](int count, const NumberLists& triangles_of) {
    std::vector<int> owners, entries;
    for (int k = 0; k < count; ++k) {
      if (triangles_of[k].empty()) continue;
      owners.push_back(triangles_of[k].front());
      entries.push_back(k);
    }
    return NumberLists(static_cast<int>(triangles_.size()), owners, entries);
  };
  own_nodes_ = owned(node_count_, node_triangles_);
  own_edges_ = owned(static_cast<int>(edges_.size()), edge_triangles_);
}

}  // namespace sinew::collision
