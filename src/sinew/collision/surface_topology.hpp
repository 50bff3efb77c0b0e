/// @file
/// What belongs to what in a triangle surface: vertices, edges, triangles. Never changes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::collision {

/// Three node numbers, counter-clockwise seen from outside.
using Triangle = std::array<NodeId, 3>;
/// Two node numbers, ascending.
using Edge = std::array<NodeId, 2>;

/// Lists of numbers, one for each of a range of things, in one piece of memory.
class NumberLists {
 public:
  /// @param count of lists. @param owners list that each entry goes to. @param entries as many;
  ///   they keep their order.
  NumberLists(int count, std::span<const int> owners, std::span<const int> entries);
  NumberLists() = default;
  std::span<const int> operator[](int list) const {
    const auto k = static_cast<std::size_t>(list);
    return {entries_.data() + begin_[k], static_cast<std::size_t>(begin_[k + 1] - begin_[k])};
  }

 private:
  std::vector<int> begin_, entries_;
};

/// Each vertex and each edge is owned by one triangle that it belongs to, the lowest one. Pairs of
/// vertices, edges and triangles are visited once if they are visited where their owners meet
/// (Curtis, Tamstorf & Manocha, "Fast collision detection for deformable models using
/// representative-triangles", I3D 2008).
class SurfaceTopology {
 public:
  /// @param triangles of the surface, open or closed; nodes that none uses are no vertices.
  /// @param node_count rows of the positions. Throws Error: empty-region (no triangle),
  ///   index-out-of-range, repeated-node-in-element.
  SurfaceTopology(std::vector<Triangle> triangles, int node_count);
  /// Of a surface that never changes its shape, which knows its flat edges. @param triangles see
  /// above. @param nodes (n, 3) m.
  static SurfaceTopology of_rigid(std::vector<Triangle> triangles, const Points& nodes);

  int node_count() const { return node_count_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// In the order of their first triangle.
  const std::vector<Edge>& edges() const { return edges_; }
  /// Edge k of a triangle joins its corners k and k + 1.
  const std::array<int, 3>& edges_of(int triangle) const {
    return triangle_edges_[static_cast<std::size_t>(triangle)];
  }
  /// One or two; more where the surface branches.
  std::span<const int> triangles_of_edge(int edge) const { return edge_triangles_[edge]; }
  std::span<const int> triangles_of_node(NodeId node) const { return node_triangles_[node]; }
  std::span<const int> edges_of_node(NodeId node) const { return node_edges_[node]; }
  /// What a triangle owns.
  std::span<const int> own_nodes(int triangle) const { return own_nodes_[triangle]; }
  std::span<const int> own_edges(int triangle) const { return own_edges_[triangle]; }

  /// Whether the surface is known not to turn outwards at an edge: it is flat or concave there, and
  /// another edge that crosses it is no nearer there than at its ends.
  bool is_flat(int edge) const {
    return !flat_.empty() && flat_[static_cast<std::size_t>(edge)] != 0;
  }
  /// Whether every edge has two triangles, which run along it in opposite directions.
  bool closed() const { return closed_; }

 private:
  void check() const;
  void number_edges();
  void list_neighbours();

  std::vector<Triangle> triangles_;
  int node_count_;
  std::vector<Edge> edges_;
  std::vector<std::array<int, 3>> triangle_edges_;
  NumberLists edge_triangles_, node_triangles_, node_edges_, own_nodes_, own_edges_;
  std::vector<char> flat_;  // of edges; empty: not known
  bool closed_ = true;
};

}  // namespace sinew::collision
