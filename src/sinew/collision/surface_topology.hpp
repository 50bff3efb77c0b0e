/// @file
/// Topology of a triangle surface: relations between its vertices, edges and triangles. Immutable.
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

/// Lists of numbers in contiguous memory, one for each of a range of indices.
class NumberLists {
 public:
  /// @param count of lists. @param owners the list of each entry.
  /// @param entries one per owner; entries of a list keep their order.
  NumberLists(int count, std::span<const int> owners, std::span<const int> entries);
  NumberLists() = default;
  std::span<const int> operator[](int list) const {
    const auto k = static_cast<std::size_t>(list);
    return {entries_.data() + begin_[k], static_cast<std::size_t>(begin_[k + 1] - begin_[k])};
  }

 private:
  std::vector<int> begin_, entries_;
};

/// Topology of a surface. Each vertex and each edge is owned by the first triangle to which it
/// belongs. Pairs of vertices, edges and triangles are visited exactly once if they are visited
/// with the pair of their owners (Curtis, Tamstorf & Manocha, "Fast collision detection for
/// deformable models using representative-triangles", I3D 2008).
class SurfaceTopology {
 public:
  /// @param triangles of the surface, open or closed; nodes without triangles are not vertices.
  /// @param node_count rows of the positions. Throws Error: empty-region (no triangle),
  ///   index-out-of-range, repeated-node-in-element.
  SurfaceTopology(std::vector<Triangle> triangles, int node_count);
  /// Topology of a rigid surface, which knows its flat edges. @param triangles as above.
  /// @param nodes (n, 3) m.
  static SurfaceTopology of_rigid(std::vector<Triangle> triangles, const Points& nodes);

  int node_count() const { return node_count_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Edges in the order of their first triangles.
  const std::vector<Edge>& edges() const { return edges_; }
  /// Edge k of a triangle joins its corners k and k + 1.
  const std::array<int, 3>& edges_of(int triangle) const {
    return triangle_edges_[static_cast<std::size_t>(triangle)];
  }
  /// Triangles of an edge: one or two; more where the surface branches.
  std::span<const int> triangles_of_edge(int edge) const { return edge_triangles_[edge]; }
  std::span<const int> triangles_of_node(NodeId node) const { return node_triangles_[node]; }
  std::span<const int> edges_of_node(NodeId node) const { return node_edges_[node]; }
  /// Nodes and edges that a triangle owns.
  std::span<const int> own_nodes(int triangle) const { return own_nodes_[triangle]; }
  std::span<const int> own_edges(int triangle) const { return own_edges_[triangle]; }

  /// Whether an edge is known not to be convex. If the surface is flat or concave there, another
  /// edge that crosses this one is no nearer there than at its ends.
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
  std::vector<char> flat_;  // (edges,) 1: not convex; empty: not known
  bool closed_ = true;
};

}  // namespace sinew::collision
