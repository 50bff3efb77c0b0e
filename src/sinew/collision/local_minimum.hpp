/// @file
/// Conditions of first order that make a pair of points a local minimum of distance.
#pragma once

#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_tree.hpp"

namespace sinew::collision {

/// One surface's part in the conditions.
class LocalMinimum {
 public:
  /// Of shares along edges and of weights in triangles: points this near to a border lie on it.
  static constexpr double kBorder = 1e-9;

  /// @param surface outlives this. @param slack see ProximitySettings.
  LocalMinimum(const SurfaceTree& surface, double slack) : surface_(surface), slack_(slack) {}

  const SurfaceTree& surface() const { return surface_; }

  /// Weights of the corners with the point's projection on a triangle; all 0 for a flat one.
  /// Whoever asks gets the same bits.
  Vector3 weights(int triangle, const Vector3& point) const;
  /// Share of the point's projection along an edge, from its first node; 0 where it has no length.
  double share(int edge, const Vector3& point) const;

  /// Whether the nearest point lies in a triangle's inside, given weights().
  static bool over_face(const Vector3& weights) { return weights.minCoeff() > kBorder; }
  /// Whether a point of an edge is none of its ends. @param share along it. @param scale of the
  ///   border: it is kBorder / scale wide.
  static bool inside_edge(double share, double scale) {
    return share * scale > kBorder && (1.0 - share) * scale > kBorder;
  }
  /// Whether, over all triangles of an edge, it lies on the edge: their insides are farther.
  /// @param edge its number. @param point (3,) m. @param inward (3,) of any length, from the point
  ///   into the body that it belongs to: triangles that are flush() with it do not count. Zero: all
  ///   count.
  bool over_edge(int edge, const Vector3& point, const Vector3& inward = Vector3::Zero()) const;
  /// Whether, over all edges of a node, it is the node. @param node,point,inward as above.
  bool over_vertex(NodeId node, const Vector3& point,
                   const Vector3& inward = Vector3::Zero()) const;
  /// Whether a point lies in the plane of a triangle that looks the same way as it does, as on the
  /// sides of two flush blocks: nothing touches there, and no way leads out. @param triangle its
  /// number. @param point,inward as above.
  bool flush(int triangle, const Vector3& point, const Vector3& inward) const;

  /// Whether a node is, up to the slack, the nearest point of its neighbourhood.
  /// @param node of the surface.
  /// @param point (3,) m, on the other surface. @param away (3,) unit length, towards it.
  bool vertex_is_nearest(NodeId node, const Vector3& point, const Vector3& away) const;
  /// The same for the triangles of an edge. @param edge its number. @param own (3,) m, on it.
  /// @param point,away as above.
  bool edge_is_nearest(int edge, const Vector3& own, const Vector3& point,
                       const Vector3& away) const;

  /// Outward normals, (3,), of any length: of an edge the sum of its triangles' unit normals, of a
  /// node their sum weighted by angles, which tells outside from inside (Baerentzen & Aanaes, IEEE
  /// TVCG 11, 2005, 243).
  Vector3 face_normal(int triangle) const;
  Vector3 edge_normal(int edge) const;
  /// Whether a surface turns at an edge by more than 30 degrees, or ends there.
  /// @param edge_normal (3,) as above.
  static bool is_ridge(const Vector3& edge_normal) { return edge_normal.squaredNorm() < kRidge; }
  Vector3 vertex_normal(NodeId node) const;

 private:
  // Of a sum of two unit vectors 30 degrees apart: 2 + sqrt(3).
  static constexpr double kRidge = 3.7320508075688772;

  bool is_within_slack(const Vector3& way, const Vector3& away) const;

  const SurfaceTree& surface_;
  double slack_;
};

}  // namespace sinew::collision
