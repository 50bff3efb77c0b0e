/// @file
/// Vertices inside a closed surface, and pairs of triangles that cross.
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
  double depth = 0.0;                 ///< m, >= 0: distance from the surface
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length: direction of the shortest way out
  NearestOnSurface nearest;           ///< the point where that way ends
};

/// Detects penetration. Order and values do not depend on the number of threads. The memory of the
/// largest call is kept; a list is valid until the next call of its kind.
class Penetration {
 public:
  /// @param pool must outlive this object.
  explicit Penetration(ThreadPool& pool);

  /// Vertices of `own` where the winding number of `other` is positive, in ascending order.
  /// @param own,other at their last moved positions; `other` is closed. Throws Error:
  ///   surface-not-closed.
  std::span<const InsideVertex> inside(const SurfaceTree& own, const SurfaceTree& other);

  /// Pairs of triangles with a common point, exactly (triangle_intersection.hpp).
  /// @param first,second at their last moved positions.
  std::span<const TrianglePair> crossing(const SurfaceTree& first, const SurfaceTree& second);
  /// The same within one surface; triangles that share a node are omitted.
  std::span<const TrianglePair> crossing_within(const SurfaceTree& surface);

 private:
  std::span<const TrianglePair> keep_crossing(const SurfaceTree& first, const SurfaceTree& second,
                                              std::span<const TrianglePair> near);

  TrianglePairs near_;
  ThreadLists<InsideVertex> inside_;
  ThreadLists<TrianglePair> crossing_;
};

/// Throws Error: surface-not-closed, naming `item`, unless the surface is closed.
void require_closed(const SurfaceTopology& topology, const char* item);

}  // namespace sinew::collision
