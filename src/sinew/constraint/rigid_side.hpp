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

/// One rigid body of a contact. It has two entries in each row: its centre and its orientation. A
/// row with direction n watches one point of the body, at the lever r from the centre: a motion v
/// of the centre and w of the orientation contributes n.v + (r x n).w.
/// `entry` is always that of the centre; the entry of the orientation is the next one.
struct RigidSide {
  mechanics::MaterialPoint centre;                ///< any point of the body
  mechanics::Orientation turn;                    ///< of the body
  Vector3 rest_centre = Vector3::Zero();          ///< (3,) m
  Vector3 rest_centre_of_mass = Vector3::Zero();  ///< (3,) m
  collision::Shape shape;                         ///< at rest, in the world

  /// Transform of the body from its pose at rest to the present one.
  Eigen::Isometry3d pose(const Configuration& configuration) const;
  /// Starts watching the point of the body that is now at `at`, (3,) m.
  void watch(const Configuration& configuration, std::size_t entry, const Vector3& at,
             mechanics::RowValues& values) const;
  /// Displacement of the watched point since watch(), (3,) m.
  Vector3 displacement(const Configuration& configuration, std::size_t entry,
                       const mechanics::RowValues& values) const;
  /// Present position of the watched point, (3,) m.
  Vector3 watched(const Configuration& configuration, std::size_t entry,
                  const mechanics::RowValues& values) const;
  /// Velocity of the point of the body that is now at `at`, (3,) m/s.
  Vector3 velocity(const Configuration& configuration, const Vector3& at) const;
  /// Writes the present lever and both entries of a row with this (3,) `direction`.
  void write(const Configuration& configuration, std::size_t entry, const Vector3& direction,
             mechanics::RowValues& values) const;
};

}  // namespace sinew::constraint
