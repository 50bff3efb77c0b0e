/// @file
/// Continuous detection of whole surfaces: which vertices, edges and faces meet along a motion.
#pragma once

#include <optional>
#include <span>

#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_tree.hpp"
#include "sinew/collision/thread_lists.hpp"
#include "sinew/collision/triangle_pairs.hpp"
#include "sinew/core/thread_pool.hpp"

namespace sinew::collision {

/// A vertex and a face, or two edges, that come too near each other.
struct SurfaceImpact {
  FeatureKind first_kind = FeatureKind::vertex, second_kind = FeatureKind::face;
  int first = -1, second = -1;  ///< nodes, edges or triangles of each surface
  double time = 0.0;            ///< from 0 to 1: a lower bound of the first one (impact.hpp)
};

/// Finds all impacts along a motion, each pair once; none is missed (impact.hpp). Two surfaces
/// without one that do not meet at the start do not meet at any time. Order and numbers do not
/// depend on the number of threads. Memory of the largest call is kept.
class SurfaceImpacts {
 public:
  /// @param pool outlives this.
  explicit SurfaceImpacts(ThreadPool& pool);

  /// @param first,second as they were swept last; one that was moved stands still.
  /// @param separation m, >= 0: the distance that counts as a meeting.
  std::span<const SurfaceImpact> between(const SurfaceTree& first, const SurfaceTree& second,
                                         double separation);
  /// Of one surface; features that share a node make no pair.
  /// @param surface as it was swept last. @param separation as above.
  std::span<const SurfaceImpact> within(const SurfaceTree& surface, double separation);

 private:
  std::span<const SurfaceImpact> collect(const SurfaceTree& first, const SurfaceTree& second,
                                         std::span<const TrianglePair> near, double separation);

  TrianglePairs near_;
  ThreadLists<SurfaceImpact> impacts_;
};

/// The least time of a list, if it has one. @param impacts of SurfaceImpacts.
std::optional<double> earliest(std::span<const SurfaceImpact> impacts);

}  // namespace sinew::collision
