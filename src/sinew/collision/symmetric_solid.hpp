/// @file
/// Bounded shapes in one form, for what two of them share.
#pragma once

#include "sinew/collision/shape.hpp"

namespace sinew::collision {

/// The Minkowski sum of a box, a disc normal to the box's third axis and a ball; each may have no
/// size. A box is the first alone, a capsule a box without width and a ball, a cylinder a box
/// without width and a disc. All are symmetric about their centre.
struct SymmetricSolid {
  Vector3 centre = Vector3::Zero();     ///< (3,) m
  Matrix3 axes = Matrix3::Identity();   ///< (3, 3) columns: of the box
  Vector3 half_size = Vector3::Zero();  ///< (3,) m, of the box, >= 0
  double rim = 0.0;                     ///< m, radius of the disc
  double radius = 0.0;                  ///< m, of the ball

  Vector3 axis() const { return axes.col(2); }
  /// (3,) m, the two ends of the box's third axis.
  Vector3 end(int side) const { return centre + (side == 0 ? -1 : 1) * half_size[2] * axis(); }
  /// A bound of all points' distance from the centre, m.
  double reach() const { return half_size.norm() + rim + radius; }
  /// Greatest of direction.(x - centre), m. @param direction (3,) unit length.
  double extent(const Vector3& direction) const;
  /// A point of box and disc, without the ball, that is farthest in a direction.
  /// @param direction (3,) not 0.
  Vector3 core_support(const Vector3& direction) const;
};

/// @param shape not a Plane, which is no bounded one: Error(internal); nor a ConvexSolid, which has
/// no such symmetry: Error(not-in-this-version).
SymmetricSolid symmetric_solid(const Shape& shape);

}  // namespace sinew::collision
