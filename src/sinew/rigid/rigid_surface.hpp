/// @file
/// Where the surface of a rigid body is.
#pragma once

#include <optional>

#include "sinew/rigid/rigid_state.hpp"

namespace sinew::rigid {

/// The nodes of a body's touching surface in a pose. @param nodes (n, 3) m, written.
void place_surface(const RigidBodyModel& model, const RigidPose& pose, Points& nodes);

/// The nodes of one body's touching surface, made anew when it has moved.
class RigidSurface {
 public:
  /// @param state must outlive this.
  explicit RigidSurface(const RigidState& state) : state_(state) {}
  const Points& nodes();       ///< (n, 3) m
  const Points& velocities();  ///< (n, 3) m/s

 private:
  const RigidState& state_;
  std::optional<RigidPose> pose_;  // of the nodes
  Points nodes_ = Points(0, 3), velocities_ = Points(0, 3);
};

}  // namespace sinew::rigid
