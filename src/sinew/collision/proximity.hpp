/// @file
/// Where two surfaces, or parts of one, come near each other: the local minima of their distance.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "sinew/collision/surface_tree.hpp"
#include "sinew/collision/thread_lists.hpp"
#include "sinew/collision/triangle_pairs.hpp"
#include "sinew/core/thread_pool.hpp"

namespace sinew::collision {

/// What a point of a surface lies on.
enum class FeatureKind : char { vertex, edge, face };

/// A point of a surface by the nodes that carry it.
struct SurfacePoint {
  FeatureKind kind = FeatureKind::vertex;
  int number = -1;                          ///< of the node, edge or triangle
  std::array<NodeId, 3> nodes{-1, -1, -1};  ///< one, two or three; the rest -1
  Vector3 weights = Vector3::Zero();        ///< (3,) of them, > 0, sum 1
  Vector3 point = Vector3::Zero();          ///< (3,) m
};

/// A local minimum of the distance of a point of one surface from a point of another.
struct ProximityPair {
  SurfacePoint first, second;
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, from the second surface to the first
  /// m: first.point - second.point = distance normal. Negative where the surfaces overlap.
  double distance = 0.0;
  /// Whether it is two edges that cross where both surfaces are nearly flat.
  bool between_flat = false;
};

/// What is looked for.
struct ProximitySettings {
  double distance = 0.0;  ///< m, >= 0: the farthest pair
  /// m, >= 0: of pairs that face each other, those are found, too, which have passed each other by
  /// no more than this. It has to be less than the thickness of either body.
  double depth = 0.0;
  /// Sine of the angle by which a neighbour of the nearest point may lie nearer: 0, local minima
  /// alone; 1, every vertex over a face or an edge and all edges that cross.
  double slack = 0.0;
  /// Of edges that cross, but for ridges of both surfaces; none: the same. Around a crossing of two
  /// flat parts there are many as near; at the corner of two blocks one crossing is all that there
  /// is, however little the faces tilt.
  std::optional<double> edge_slack;
  /// Only points that see each other from outside, by the normals of their features. Without, a
  /// thin body's sides see each other through it, and open surfaces have two sides.
  bool facing = true;
};

/// Finds all pairs (p, q) where distance rises to first order, or stays, whichever way p or q
/// leaves its place. They are told apart by what the points lie on: a vertex or an edge's inside
/// or a triangle's inside, each over one of these where the other one lets it, and two edges that
/// cross. Decisions on one border are made by one number, so that each pair is found once: over
/// an edge between two triangles a vertex has one pair, with the edge. Of features that run along
/// each other, such as two faces on one another, vertices stand for the whole.
///
/// Order and numbers do not depend on the number of threads. Memory of the largest call is kept.
class Proximity {
 public:
  /// @param pool outlives this.
  explicit Proximity(ThreadPool& pool);

  /// @param first,second as they were moved last. @param settings see there.
  std::span<const ProximityPair> between(const SurfaceTree& first, const SurfaceTree& second,
                                         const ProximitySettings& settings);
  /// Of one surface; features that share a node make no pair.
  /// @param surface as it was moved last. @param settings see there.
  std::span<const ProximityPair> within(const SurfaceTree& surface,
                                        const ProximitySettings& settings);

 private:
  std::span<const ProximityPair> collect(const SurfaceTree& first, const SurfaceTree& second,
                                         std::span<const TrianglePair> near,
                                         const ProximitySettings& settings);

  TrianglePairs near_;
  ThreadLists<ProximityPair> pairs_;
};

}  // namespace sinew::collision
