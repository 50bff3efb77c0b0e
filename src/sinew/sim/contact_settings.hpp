/// @file
/// What a robot may touch.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sinew/collision/shape.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/sim/base_motion.hpp"

namespace sinew::mechanics {
class BodyModel;
}

namespace sinew::sim {

/// Points of a body that may touch a surface.
struct ContactSettings {
  constraint::Friction coefficients() const {
    return {friction, kinetic_friction.value_or(friction)};
  }

  std::string name;
  Location place;
  int body = 0;
  collision::Shape surface;  ///< where it is at rest, in the world
  /// The body that is touched, in place of the surface: a rigid one with its shape, or by surfaces
  /// (touch_by_surfaces()), which may be parts of one body's.
  std::optional<int> touched;
  std::vector<NodeId> nodes;  ///< of the body's mesh; fixed ones are left out
  Points points;  ///< (n, 3) m, at rest; beside the nodes. Neither: a rigid body's shape
  mesh::Outside outside = mesh::Outside::error;
  double friction = 0.0;                   ///< Coulomb's coefficient, >= 0
  std::optional<double> kinetic_friction;  ///< of points that slide; none: the same
  std::optional<BaseMotion> motion;        ///< of the surface
  /// Newton's, 0 to 1; none: StepSettings::restitution. Of rigid bodies in event-driven
  /// integration.
  std::optional<double> restitution;
  /// m, the size of zones whose points act as one (ContactZones); 0: all points by themselves. Of
  /// deformable bodies.
  double aggregate = 0.0;
};

/// Of a ball's radius: a triangle of such edges goes up to 1/24 of the radius into a ball that its
/// corners touch.
inline constexpr double kFineEdge = 0.5;

/// Whether two bodies touch with the triangles of their surfaces. Deformable ones do, with others,
/// too. But a ball or a capsule touches a deformable surface of edges up to kFineEdge of its radius
/// at the nodes of that, exactly round. Of rigid bodies, meshes do; others touch as shapes. An arm
/// touches with points alone.
/// @param one,other the bodies, in either order.
/// @param named nodes or points of one are named: they touch a rigid body's shape or hull.
bool touch_by_surfaces(const mechanics::BodyModel& one, const mechanics::BodyModel& other,
                       bool named);

}  // namespace sinew::sim
