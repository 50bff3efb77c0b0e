/// @file
/// A rigid body that takes part in a contact.
#pragma once

#include <cstddef>

#include <Eigen/Geometry>

#include "sinew/collision/shape.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/mechanics/site.hpp"

namespace sinew::constraint {

class Configuration;

/// It has two entries in each row, of its centre and of its orientation. A row with direction n
/// watches one of the body's points, at the lever r from the centre: a motion v of the centre and
/// w of the orientation counts as n.v + (r x n).w.
/// `entry` below is always that of the centre; the orientation's is the next one.
struct RigidSide {
  mechanics::MaterialPoint centre;        ///< any of its points
  mechanics::Orientation turn;            ///< of it
  Vector3 rest_centre = Vector3::Zero();  ///< (3,) m
  collision::Shape shape;                 ///< at rest, in the world

  /// Where it is now, from rest.
  Eigen::Isometry3d pose(const Configuration& configuration) const;
  /// Watches the body's point that is at (3,) m now.
  void watch(const Configuration& configuration, std::size_t entry, const Vector3& at,
             mechanics::RowValues& values) const;
  /// (3,) m: how far that point has moved since.
  Vector3 displacement(const Configuration& configuration, std::size_t entry,
                       const mechanics::RowValues& values) const;
  /// (3,) m: where that point is now.
  Vector3 watched(const Configuration& configuration, std::size_t entry,
                  const mechanics::RowValues& values) const;
  /// (3,) m/s of the body's point that is at (3,) m now.
  Vector3 velocity(const Configuration& configuration, const Vector3& at) const;
  /// Levers as they are now, and the entries of a row in (3,) `direction`.
  void write(const Configuration& configuration, std::size_t entry, const Vector3& direction,
             mechanics::RowValues& values) const;
};

}  // namespace sinew::constraint
