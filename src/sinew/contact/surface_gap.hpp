/// @file
/// The present distance of two surfaces, for results.
#pragma once

#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_tree.hpp"
#include "sinew/core/thread_pool.hpp"

namespace sinew::constraint {
class Configuration;
class SurfaceContact;
}  // namespace sinew::constraint

namespace sinew::contact {

/// Measures how far the surfaces of a SurfaceContact are apart as they stand. The points of a step
/// (TouchingSurfaces) were found where it began, and other places may have come nearer since. It
/// has trees of its own, so that a reading changes nothing that a step depends on.
class SurfaceGap {
 public:
  /// All must outlive it. @param contact of the surfaces. @param configuration of the bodies.
  /// @param pool shares the work of a search.
  SurfaceGap(const constraint::SurfaceContact& contact,
             const constraint::Configuration& configuration, ThreadPool& pool);

  /// m: the smallest distance, minus the separation; negative where the surfaces overlap. Infinity
  /// if it exceeds `distance`. Places that are immovable on both surfaces do not count.
  /// @param distance m, > 0.
  double measure(double distance);

 private:
  const constraint::SurfaceContact& contact_;
  const constraint::Configuration& configuration_;
  ThreadPool& pool_;
  collision::Proximity proximity_;
  collision::SurfaceTree first_, second_;  // the second one stands still within one surface
};

}  // namespace sinew::contact
