/// @file
/// Bodies that are a base as a whole.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::mechanics {

/// A body all of which goes where it is put (HasBase): a rigid one that is fixed. Of one that is
/// free nothing happens.
class HasRigidBase {
 public:
  virtual ~HasRigidBase() = default;
  /// Goes to where it was asked to be without a step's beginning: the second half of a step of the
  /// midpoint rule.
  virtual void follow_base() = 0;
  /// How fast it goes now, until the next step ends. @param linear (3,) m/s, of its centre of mass.
  /// @param angular (3,) rad/s.
  virtual void set_base_rate(const Vector3& linear, const Vector3& angular) = 0;
};

}  // namespace sinew::mechanics
