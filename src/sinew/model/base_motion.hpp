/// @file
/// Prescribed motions of bases and surfaces.
#pragma once

#include <array>

#include "sinew/core/types.hpp"
#include "sinew/model/signal.hpp"

namespace sinew {
struct Location;
}

namespace sinew::model {

/// A rigid motion prescribed over time, from rest: of a body's fixed nodes or of a surface.
struct BaseMotion {
  int body = 0;                       ///< whose fixed nodes move; unused for a surface
  std::array<Signal, 3> translation;  ///< m, along x, y, z
  Signal angle;                       ///< rad
  Vector3 axis = Vector3::UnitZ();    ///< of the rotation, unit length
  Vector3 centre = Vector3::Zero();   ///< of the rotation, m

  /// (3,) m and (3,) rad at a time.
  Vector3 translation_at(double time) const {
    return {translation[0].value(time), translation[1].value(time), translation[2].value(time)};
  }
  Vector3 rotation_at(double time) const { return angle.value(time) * axis; }

  /// Velocity field of a rigid motion.
  struct Rate {
    Vector3 centre = Vector3::Zero();   ///< (3,) m, present position of the centre of rotation
    Vector3 linear = Vector3::Zero();   ///< (3,) m/s, velocity of the centre
    Vector3 angular = Vector3::Zero();  ///< (3,) rad/s
    /// (3,) m/s, velocity of a point whose present position is `place`, (3,) m.
    Vector3 at(const Vector3& place) const { return linear + angular.cross(place - centre); }
  };
  /// See the functions of Signal. @param time s. @param side of a corner there.
  Rate rate(double time, Signal::Side side) const;
  double next_corner(double time) const;
  bool jumps() const;
};

/// Normalises an axis. @param axis (3,).
/// @param place source location. Throws Error(out-of-range) for an axis without length.
Vector3 checked_axis(const Vector3& axis, const Location& place);

}  // namespace sinew::model
