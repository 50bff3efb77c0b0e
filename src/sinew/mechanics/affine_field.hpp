/// @file
/// Rigid motions as affine fields over rest positions.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::mechanics {

/// An affine field over rest positions X (m): linear X + constant, stored as (3, 4) = [linear,
/// constant]. The displacements (m) of a rigid motion are such fields, and so are linear
/// combinations of them in time: velocities (m/s) and accelerations (m/s^2).
using AffineField = Eigen::Matrix<double, 3, 4>;

inline Vector3 value_at(const AffineField& field, const Vector3& rest) {
  return field.leftCols<3>() * rest + field.col(3);
}

/// Displacement field of a rigid motion: a rotation about `centre`, followed by a translation.
/// @param translation (3,) m. @param rotation (3,) rotation vector, rad. @param centre (3,) m, at
///   rest.
/// Throws Error(not-finite).
AffineField rigid_displacement(const Vector3& translation, const Vector3& rotation,
                               const Vector3& centre);

}  // namespace sinew::mechanics
