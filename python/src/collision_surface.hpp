/// @file
/// A triangle surface as Python holds it.
#pragma once

#include <memory>

#include "sinew/collision/surface_tree.hpp"

namespace sinew::python {

/// It never changes, so that threads may share it. Surfaces made from one by moving it share its
/// topology, and their boxes are refitted, not built anew.
struct CollisionSurface {
  std::shared_ptr<const collision::SurfaceTopology> topology;
  collision::SurfaceTree tree;
};
using SharedSurface = std::shared_ptr<CollisionSurface>;

}  // namespace sinew::python
