/// @file
/// Continuous collision detection of whole surfaces: finds the vertices, edges and faces that meet
/// along a motion.
#pragma once

#include <optional>
#include <span>

#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_tree.hpp"
#include "sinew/collision/thread_lists.hpp"
#include "sinew/collision/triangle_pairs.hpp"
#include "sinew/core/thread_pool.hpp"

namespace sinew::collision {

/// A vertex and a face, or two edges, that meet.
struct SurfaceImpact {
  FeatureKind first_kind = FeatureKind::vertex, second_kind = FeatureKind::face;
  int first = -1, second = -1;  ///< number of the node, edge or triangle
  double time = 0.0;            ///< from 0 to 1: a lower bound of the first meeting (impact.hpp)
};

/// Finds all impacts along a motion, each pair once; none is missed (impact.hpp). If there are
/// none, two surfaces that do not meet at the start never meet. Order and values do not depend on
/// the number of threads. The memory of the largest call is kept.
class SurfaceImpacts {
 public:
  /// @param pool must outlive this object.
  explicit SurfaceImpacts(ThreadPool& pool);

  /// Impacts between two surfaces. @param first,second with their last sweep(); one whose last call
  /// was move() stands still.
  /// @param separation m, >= 0: the distance that counts as a meeting.
  std::span<const SurfaceImpact> between(const SurfaceTree& first, const SurfaceTree& second,
                                         double separation);
  /// Impacts within one surface; features that share a node form no pair.
  /// @param surface with its last sweep(). @param separation as above.
  std::span<const SurfaceImpact> within(const SurfaceTree& surface, double separation);

 private:
  std::span<const SurfaceImpact> collect(const SurfaceTree& first, const SurfaceTree& second,
                                         std::span<const TrianglePair> near, double separation);

  TrianglePairs near_;
  ThreadLists<SurfaceImpact> impacts_;
};

/// The earliest time of a list, if it is not empty. @param impacts of SurfaceImpacts.
std::optional<double> earliest(std::span<const SurfaceImpact> impacts);

}  // namespace sinew::collision
