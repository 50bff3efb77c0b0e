/// @file
/// A contact of a body with a surface or another body.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sinew/collision/shape.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/model/base_motion.hpp"

namespace sinew::mechanics {
class BodyModel;
}

namespace sinew::builder {

/// Points of a body that may touch a surface or another body.
struct ContactSettings {
  constraint::Friction coefficients() const {
    return {friction, kinetic_friction.value_or(friction)};
  }

  std::string name;
  Location place;
  int body = 0;
  collision::Shape surface;  ///< at rest, in world coordinates
  /// The body that is touched, in place of a surface of the world: a rigid body with its shape, or
  /// a body whose surface triangles touch (touch_by_surfaces()), which may be the same body.
  std::optional<int> touched;
  std::vector<NodeId> nodes;  ///< of the body's mesh; fixed nodes are left out
  Points points;  ///< (n, 3) m, at rest, in addition to nodes; neither: a rigid body's shape
  mesh::Outside outside = mesh::Outside::error;
  double friction = 0.0;                    ///< Coulomb's coefficient, >= 0
  std::optional<double> kinetic_friction;   ///< of sliding points; none: equal to `friction`
  std::optional<model::BaseMotion> motion;  ///< of the surface
  /// Newton's coefficient of restitution, 0 to 1, for rigid bodies in event-driven integration;
  /// none: StepSettings::restitution.
  std::optional<double> restitution;
  /// m, size of the zones whose points act as one (ContactZones), for deformable bodies; 0: every
  /// point acts by itself.
  double aggregate = 0.0;
};

/// Maximum edge length of a deformable surface that a ball touches at nodes, relative to the ball's
/// radius: a triangle of such edges penetrates a ball that its corners touch by at most 1/24 of the
/// radius.
inline constexpr double kFineEdge = 0.5;

/// Whether two bodies touch with the triangles of their surfaces. Deformable bodies do, also with
/// other bodies. But a ball or capsule touches a deformable surface with edges up to kFineEdge of
/// its radius at the nodes of that surface, as an exact shape. Of rigid bodies, meshes touch with
/// triangles, others as shapes. An arm touches with points only.
/// @param one,other the bodies, in either order.
/// @param named whether nodes or points of one body are named: they touch a rigid body's shape or
///   hull.
bool touch_by_surfaces(const mechanics::BodyModel& one, const mechanics::BodyModel& other,
                       bool named);

}  // namespace sinew::builder
