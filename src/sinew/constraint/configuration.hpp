/// @file
/// Where the bodies are when constraints are evaluated.
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

/// Where the sites of all bodies are now.
class Configuration {
 public:
  /// @param bodies outlive it.
  explicit Configuration(std::span<const std::unique_ptr<mechanics::Body>> bodies);
  /// (3,) m.
  Vector3 position(const mechanics::MaterialPoint& point) const;
  /// Rotation since rest.
  Matrix3 rotation(const mechanics::Orientation& section) const;
  /// rad or m.
  double coordinate(const mechanics::Coordinate& coordinate) const;
  /// (3,) rate of a site's motion: m/s; of an orientation, its angular velocity, rad/s; of a
  /// coordinate, (rate, 0, 0).
  Vector3 velocity(const mechanics::Site& site) const;
  /// (n, 3) m and m/s, of the nodes of a body's surface (HasSurface). @param body in the world's
  /// list.
  const Points& surface_nodes(int body) const;
  const Points& surface_node_velocities(int body) const;

 private:
  std::span<const std::unique_ptr<mechanics::Body>> bodies_;
  std::vector<const mechanics::HasOrientations*> oriented_;  // (bodies,) null: without
};

}  // namespace sinew::constraint
