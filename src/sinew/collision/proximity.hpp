/// @file
/// Local minima of the distance between two surfaces, or between parts of one.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sinew/collision/normal_cones.hpp"
#include "sinew/collision/surface_tree.hpp"
#include "sinew/collision/thread_lists.hpp"
#include "sinew/collision/triangle_pairs.hpp"
#include "sinew/core/thread_pool.hpp"

namespace sinew::collision {

/// The kind of feature on which a surface point lies.
enum class FeatureKind : char { vertex, edge, face };

/// A point of a surface, given by the nodes of its feature.
struct SurfacePoint {
  FeatureKind kind = FeatureKind::vertex;
  int number = -1;                          ///< of the node, edge or triangle
  std::array<NodeId, 3> nodes{-1, -1, -1};  ///< one, two or three; the rest -1
  Vector3 weights = Vector3::Zero();        ///< (3,) of these nodes, > 0, sum 1
  Vector3 point = Vector3::Zero();          ///< (3,) m
};

/// A local minimum of the distance between a point of one surface and a point of another.
struct ProximityPair {
  SurfacePoint first, second;
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, from the second surface to the first
  /// m: first.point - second.point = distance normal. Negative where the surfaces overlap.
  double distance = 0.0;
  /// Whether it is a pair of crossing edges where both surfaces are nearly flat.
  bool between_flat = false;
};

/// Criteria of the search.
struct ProximitySettings {
  /// m, >= 0: the largest distance of a pair. Triangles that are expected to move farther together
  /// (SurfaceTree::expect()) form pairs up to the sum of their motions.
  double distance = 0.0;
  /// m, >= 0: pairs that face each other are also found if they have passed each other by up to
  /// this depth. It must be less than the thickness of either body.
  double depth = 0.0;
  /// Sine of the angle by which a neighbour of the nearest point may be nearer. 0: local minima
  /// only; 1: every vertex over a face or an edge, and all crossing edges.
  double slack = 0.0;
  /// The slack for crossing edges, except where both are ridges; none: `slack`. Around a crossing
  /// of two flat parts there are many equally near pairs. At the corner of two blocks, one crossing
  /// is the only pair, however little the faces tilt.
  std::optional<double> edge_slack;
  /// Only points that face each other from outside, by the normals of their features. Without this,
  /// the two sides of a thin body see each other through it, and open surfaces have two sides.
  bool facing = true;
};

/// Finds all pairs (p, q) for which the distance does not decrease to first order, however p or q
/// moves. Pairs are classified by the features on which the points lie: a vertex, or the interior
/// of an edge or triangle, each over one of these if the other side permits it, and two crossing
/// edges. Decisions about one border use one number, so that each pair is found once: over an edge
/// between two triangles, a vertex has one pair, with the edge. Features that run along each other,
/// such as two parallel faces in contact, are represented by their vertices.
///
/// Order and values do not depend on the number of threads. The memory of the largest call is kept.
class Proximity {
 public:
  /// @param pool must outlive this object.
  explicit Proximity(ThreadPool& pool);

  /// Pairs between two surfaces. @param first,second at their last moved positions.
  /// @param settings criteria.
  std::span<const ProximityPair> between(const SurfaceTree& first, const SurfaceTree& second,
                                         const ProximitySettings& settings);
  /// Pairs within one surface; features that share a node form no pair.
  /// @param surface at its last moved position. @param settings criteria.
  std::span<const ProximityPair> within(const SurfaceTree& surface,
                                        const ProximitySettings& settings);
  /// Those of the given pairs of edges that cross within the distance and face each other, whether
  /// or not a neighbour of the crossing is nearer. In the order of `edges`.
  /// @param first,second at their last moved positions; one surface twice: pairs within it.
  /// @param edges numbers of edges of the first and the second surface. @param settings criteria.
  std::span<const ProximityPair> crossings(const SurfaceTree& first, const SurfaceTree& second,
                                           std::span<const std::array<int, 2>> edges,
                                           ProximitySettings settings);

 private:
  std::span<const ProximityPair> collect(const SurfaceTree& first, const SurfaceTree& second,
                                         std::span<const TrianglePair> near,
                                         const ProximitySettings& settings);

  ThreadPool& pool_;
  TrianglePairs near_;
  NormalCones cones_;
  ThreadLists<ProximityPair> pairs_;
  std::vector<ProximityPair> crossings_;
};

}  // namespace sinew::collision
