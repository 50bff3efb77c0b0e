/// @file
/// Positions of points that move with a rigid body.
#pragma once

#include <optional>

#include "sinew/rigid/rigid_state.hpp"

namespace sinew::rigid {

/// Computes the points of a body in a pose. @param model of the body.
/// @param rest (n, 3) m, at rest, in the world. @param pose of the body.
/// @param nodes (n, 3) m, written.
void place_nodes(const RigidBodyModel& model, const Points& rest, const RigidPose& pose,
                 Points& nodes);

/// The nodes of a body's skin or touching surface, updated when the body has moved.
class RigidNodes {
 public:
  /// @param state,rest must outlive this; see place_nodes().
  RigidNodes(const RigidState& state, const Points& rest) : state_(state), rest_(rest) {}
  const Points& positions();   ///< (n, 3) m
  const Points& velocities();  ///< (n, 3) m/s
  std::size_t bytes() const { return 6 * sizeof(double) * static_cast<std::size_t>(rest_.rows()); }

 private:
  const RigidState& state_;
  const Points& rest_;
  std::optional<RigidPose> pose_;  // pose of the positions
  Points positions_ = Points(0, 3), velocities_ = Points(0, 3);
};

}  // namespace sinew::rigid
