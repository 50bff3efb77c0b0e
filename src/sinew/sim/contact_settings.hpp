/// @file
/// What a robot may touch.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sinew/collision/shape.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/sim/base_motion.hpp"

namespace sinew::sim {

/// Points of a body that may touch a surface.
struct ContactSettings {
  std::string name;
  Location place;
  int body = 0;
  collision::Shape surface;  ///< where it is at rest, in the world
  /// The body that is touched, in place of the surface: a rigid one with its shape. A deformable
  /// one with its surface by that of `body`, of which it may be parts; nodes and points do not
  /// count.
  std::optional<int> touched;
  std::vector<NodeId> nodes;  ///< of the body's mesh; fixed ones are left out
  Points points;  ///< (n, 3) m, at rest; beside the nodes. Neither: a rigid body's shape
  mesh::Outside outside = mesh::Outside::error;
  double friction = 0.0;             ///< Coulomb's coefficient, >= 0
  std::optional<BaseMotion> motion;  ///< of the surface
  /// Newton's, 0 to 1; none: StepSettings::restitution. Of rigid bodies in event-driven
  /// integration.
  std::optional<double> restitution;
};

}  // namespace sinew::sim
