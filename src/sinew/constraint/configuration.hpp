/// @file
/// The configuration of all bodies at which constraints are evaluated.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/site.hpp"

namespace sinew::mechanics {
class Body;
class HasOrientations;
}  // namespace sinew::mechanics

namespace sinew::constraint {

/// The present positions, rotations and velocities of the sites of all bodies.
class Configuration {
 public:
  /// @param bodies must outlive this object.
  explicit Configuration(std::span<const std::unique_ptr<mechanics::Body>> bodies);
  /// Position, (3,) m.
  Vector3 position(const mechanics::MaterialPoint& point) const;
  /// Rotation from the pose at rest.
  Matrix3 rotation(const mechanics::Orientation& section) const;
  /// Value of a coordinate, rad or m.
  double coordinate(const mechanics::Coordinate& coordinate) const;
  /// Velocity of a site, (3,): m/s for a point; angular velocity, rad/s, for an orientation; (rate,
  /// 0, 0) for a coordinate.
  Vector3 velocity(const mechanics::Site& site) const;
  /// Positions (m) and velocities (m/s) of the nodes of a body's surface, (n, 3). The body must
  /// have the capability HasSurfaceNodes. @param body its index in the world's list.
  const Points& surface_nodes(int body) const;
  const Points& surface_node_velocities(int body) const;

 private:
  std::span<const std::unique_ptr<mechanics::Body>> bodies_;
  std::vector<const mechanics::HasOrientations*> oriented_;  // (bodies,) null: has no orientations
};

}  // namespace sinew::constraint
