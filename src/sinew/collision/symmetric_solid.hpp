/// @file
/// A common form of bounded shapes, for queries between two of them.
#pragma once

#include "sinew/collision/shape.hpp"

namespace sinew::collision {

/// The Minkowski sum of a box, a disc normal to the box's third axis, and a ball; each may have
/// zero size. A box is the first alone, a capsule is a box without width plus a ball, and a
/// cylinder is a box without width plus a disc. All are symmetric about their centre.
struct SymmetricSolid {
  Vector3 centre = Vector3::Zero();     ///< (3,) m
  Matrix3 axes = Matrix3::Identity();   ///< (3, 3) columns: axes of the box
  Vector3 half_size = Vector3::Zero();  ///< (3,) m, of the box, >= 0
  double rim = 0.0;                     ///< m, radius of the disc
  double radius = 0.0;                  ///< m, of the ball

  Vector3 axis() const { return axes.col(2); }
  /// The two ends of the box's third axis, (3,) m.
  Vector3 end(int side) const { return centre + (side == 0 ? -1 : 1) * half_size[2] * axis(); }
  /// An upper bound of the points' distance from the centre, m.
  double reach() const { return half_size.norm() + rim + radius; }
  /// Largest direction.(x - centre), m. @param direction (3,) unit length.
  double extent(const Vector3& direction) const;
  /// The farthest point of box and disc, without the ball, in a direction.
  /// @param direction (3,) not 0.
  Vector3 core_support(const Vector3& direction) const;
};

/// Converts a shape. Throws Error: internal for a Plane, which is not bounded; not-in-this-version
/// for a ConvexSolid, which is not symmetric. @param shape to convert.
SymmetricSolid symmetric_solid(const Shape& shape);

}  // namespace sinew::collision
