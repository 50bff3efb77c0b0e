/// @file
/// What lies inside a closed surface, and which triangles cross.
#pragma once

#include <span>

#include "sinew/collision/point_query.hpp"
#include "sinew/collision/surface_tree.hpp"
#include "sinew/collision/thread_lists.hpp"
#include "sinew/collision/triangle_pairs.hpp"
#include "sinew/core/thread_pool.hpp"

namespace sinew::collision {

/// A vertex inside another surface.
struct InsideVertex {
  NodeId node = -1;
  double depth = 0.0;                 ///< m, >= 0: the distance of the surface
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length: the shortest way out
  NearestOnSurface nearest;           ///< where it leads to
};

/// Order and numbers do not depend on the number of threads. Memory of the largest call is kept;
/// a list is valid until the next call of its kind.
class Penetration {
 public:
  /// @param pool outlives this.
  explicit Penetration(ThreadPool& pool);

  /// Vertices of one surface where the winding number of the other one is positive, by number.
  /// @param own,other as they were moved last; `other` is closed. Throws Error(surface-not-closed).
  std::span<const InsideVertex> inside(const SurfaceTree& own, const SurfaceTree& other);

  /// Pairs of triangles that have a point in common, exactly (triangle_intersection.hpp).
  /// @param first,second as they were moved last.
  std::span<const TrianglePair> crossing(const SurfaceTree& first, const SurfaceTree& second);
  /// The same within one surface; triangles that share a node are left out.
  std::span<const TrianglePair> crossing_within(const SurfaceTree& surface);

 private:
  std::span<const TrianglePair> keep_crossing(const SurfaceTree& first, const SurfaceTree& second,
                                              std::span<const TrianglePair> near);

  TrianglePairs near_;
  ThreadLists<InsideVertex> inside_;
  ThreadLists<TrianglePair> crossing_;
};

/// Throws Error(surface-not-closed) at `item` unless the surface is closed.
void require_closed(const SurfaceTopology& topology, const char* item);

}  // namespace sinew::collision
