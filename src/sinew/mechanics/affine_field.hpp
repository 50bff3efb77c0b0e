/// @file
/// Rigid motions as fields over rest positions.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::mechanics {

/// A field over rest positions X (m): linear X + constant, stored as (3, 4) = [linear, constant].
/// Displacements (m) of a rigid motion are such fields, and so are all combinations of them over
/// time: velocities (m/s) and accelerations (m/s^2).
using AffineField = Eigen::Matrix<double, 3, 4>;

inline Vector3 value_at(const AffineField& field, const Vector3& rest) {
  return field.leftCols<3>() * rest + field.col(3);
}

/// The displacement of a rigid motion: turned about `centre` by a rotation vector, then moved.
/// @param translation (3,) m. @param rotation (3,) rad. @param centre (3,) m, at rest.
/// Throws Error(not-finite).
AffineField rigid_displacement(const Vector3& translation, const Vector3& rotation,
                               const Vector3& centre);

}  // namespace sinew::mechanics
