/// @file
/// Motions that are given over time.
#pragma once

#include <array>

#include "sinew/core/types.hpp"
#include "sinew/sim/signal.hpp"

namespace sinew {
struct Location;
}

namespace sinew::sim {

/// A motion given over time, from rest: of a body's fixed nodes or of a surface.
struct BaseMotion {
  int body = 0;                       ///< whose fixed nodes; a surface has none
  std::array<Signal, 3> translation;  ///< m, along x, y, z
  Signal angle;                       ///< rad
  Vector3 axis = Vector3::UnitZ();    ///< of the turn, unit length
  Vector3 centre = Vector3::Zero();   ///< of the turn, m

  /// (3,) m and (3,) rad at a time.
  Vector3 translation_at(double time) const {
    return {translation[0].value(time), translation[1].value(time), translation[2].value(time)};
  }
  Vector3 rotation_at(double time) const { return angle.value(time) * axis; }

  /// A rigid motion's rate.
  struct Rate {
    Vector3 centre = Vector3::Zero();   ///< (3,) m, of the turn, where it is then
    Vector3 linear = Vector3::Zero();   ///< (3,) m/s, of that
    Vector3 angular = Vector3::Zero();  ///< (3,) rad/s
    /// (3,) m/s of what is at (3,) m then.
    Vector3 at(const Vector3& place) const { return linear + angular.cross(place - centre); }
  };
  /// These are as Signal's. @param time s. @param side of a corner there.
  Rate rate(double time, Signal::Side side) const;
  double next_corner(double time) const;
  bool jumps() const;
};

/// An axis of unit length. @param axis,place (3,), and where it was written. Throws
/// Error(out-of-range) for one without length.
Vector3 checked_axis(const Vector3& axis, const Location& place);

}  // namespace sinew::sim
