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
};

/// An axis of unit length. @param axis,place (3,), and where it was written. Throws
/// Error(out-of-range) for one without length.
Vector3 checked_axis(const Vector3& axis, const Location& place);

}  // namespace sinew::sim
