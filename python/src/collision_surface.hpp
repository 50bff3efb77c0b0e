/// @file
/// The triangle surface behind sinew.collision.Surface.
#pragma once

#include <memory>

#include "sinew/collision/surface_tree.hpp"

namespace sinew::python {

/// An immutable surface, which threads may share. Surfaces made by moving it share its topology,
/// and their bounding boxes are refitted instead of rebuilt.
struct CollisionSurface {
  std::shared_ptr<const collision::SurfaceTopology> topology;
  collision::SurfaceTree tree;
};
using SharedSurface = std::shared_ptr<CollisionSurface>;

}  // namespace sinew::python
