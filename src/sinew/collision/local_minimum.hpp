/// @file
/// First-order conditions for a pair of points to be a local minimum of distance.
#pragma once

#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_tree.hpp"

namespace sinew::collision {

/// The conditions on one of the two surfaces.
class LocalMinimum {
 public:
  /// Relative to shares along edges and weights in triangles: points within this of a border lie on
  /// it.
  static constexpr double kBorder = 1e-9;

  /// @param surface must outlive this object. @param slack see ProximitySettings.
  LocalMinimum(const SurfaceTree& surface, double slack) : surface_(surface), slack_(slack) {}

  const SurfaceTree& surface() const { return surface_; }

  /// Weights of the corners for the projection of a point onto a triangle; all 0 for a degenerate
  /// one. Every caller gets the same bits.
  Vector3 weights(int triangle, const Vector3& point) const;
  /// Share of a point's projection along an edge, from its first node; 0 for an edge without
  /// length.
  double share(int edge, const Vector3& point) const;

  /// Whether the nearest point lies in the interior of a triangle, given weights().
  static bool over_face(const Vector3& weights) { return weights.minCoeff() > kBorder; }
  /// Whether a point of an edge is neither of its ends. @param share along the edge.
  /// @param scale of the border, which has the width kBorder / scale.
  static bool inside_edge(double share, double scale) {
    return share * scale > kBorder && (1.0 - share) * scale > kBorder;
  }
  /// Whether the nearest point of all triangles of an edge lies on the edge: their interiors are
  /// farther. @param edge its number. @param point (3,) m.
  /// @param inward (3,) of any length, from the point into its own body: triangles that are flush()
  ///   with it do not count. Zero: all count.
  bool over_edge(int edge, const Vector3& point, const Vector3& inward = Vector3::Zero()) const;
  /// Whether the nearest point of all edges of a node is the node. @param node,point,inward as
  /// above.
  bool over_vertex(NodeId node, const Vector3& point,
                   const Vector3& inward = Vector3::Zero()) const;
  /// Whether a point lies in the plane of a triangle that faces the same way as the point's own
  /// surface, as on the sides of two flush blocks: nothing touches there, and no way leads out.
  /// @param triangle its number. @param point,inward as above.
  bool flush(int triangle, const Vector3& point, const Vector3& inward) const;

  /// Whether a node is the nearest point of its neighbourhood, up to the slack.
  /// @param node of the surface.
  /// @param point (3,) m, on the other surface. @param away (3,) unit length, towards `point`.
  bool vertex_is_nearest(NodeId node, const Vector3& point, const Vector3& away) const;
  /// The same for an edge and its triangles. @param edge its number. @param own (3,) m, on the
  /// edge.
  /// @param point,away as above.
  bool edge_is_nearest(int edge, const Vector3& own, const Vector3& point,
                       const Vector3& away) const;

  /// Outward normals, (3,), of any length. That of an edge is the sum of the unit normals of its
  /// triangles; that of a node is their sum weighted by angles, which distinguishes outside from
  /// inside (Baerentzen & Aanaes, IEEE TVCG 11, 2005, 243).
  Vector3 face_normal(int triangle) const;
  Vector3 edge_normal(int edge) const;
  /// Whether a surface turns at an edge by more than 30 degrees, or ends there.
  /// @param edge_normal (3,) as above.
  static bool is_ridge(const Vector3& edge_normal) { return edge_normal.squaredNorm() < kRidge; }
  Vector3 vertex_normal(NodeId node) const;

 private:
  // Squared length of the sum of two unit vectors 30 degrees apart: 2 + sqrt(3).
  static constexpr double kRidge = 3.7320508075688772;

  bool is_within_slack(const Vector3& way, const Vector3& away) const;

  const SurfaceTree& surface_;
  double slack_;
};

}  // namespace sinew::collision
