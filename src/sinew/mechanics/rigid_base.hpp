/// @file
/// Rigid bodies that are a base as a whole.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::mechanics {

/// A rigid body that, if fixed, moves as a whole with its base (HasBase). On a free body these
/// functions have no effect.
class HasRigidBase {
 public:
  virtual ~HasRigidBase() = default;
  /// Moves to the requested displacement outside of begin_step(), in the second half of a midpoint
  /// step.
  virtual void follow_base() = 0;
  /// Sets the velocity until the next step ends. @param linear (3,) m/s, of the centre of mass.
  /// @param angular (3,) rad/s.
  virtual void set_base_rate(const Vector3& linear, const Vector3& angular) = 0;
};

}  // namespace sinew::mechanics
