/// @file
/// Rotations as matrices, rotation vectors (axis times angle, rad) and quaternions, in fixed axes.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew {

/// The cross-product matrix [v], with [v] x = v cross x.
inline Matrix3 cross_matrix(const Vector3& v) {
  Matrix3 m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}
/// Rotation matrix exp([v]) of a rotation vector.
Matrix3 rotation_matrix(const Vector3& v);
/// Moves points from x to R x + d. @param points (n, 3) m. @param rotation R. @param displacement d
/// (3,) m.
Points moved(const Points& points, const Matrix3& rotation, const Vector3& displacement);
/// The shortest rotation vector of a rotation, of length 0 to pi.
Vector3 rotation_vector(const Matrix3& rotation);
/// The unit quaternion of a rotation: w, x, y, z with w >= 0.
Eigen::Vector4d unit_quaternion(const Matrix3& rotation);
/// D with rotation_vector(exp[w] exp[v]) = v + D w + O(w^2), the inverse of the left Jacobian
/// (Chirikjian, Stochastic Models, Information Theory, and Lie Groups 2, 2011, eq. 10.86):
///   D = 1 - [v]/2 + (1/a^2 - 1/(2 a tan(a/2))) [v]^2,  a = |v|.
/// @param v shorter than 2 pi.
Matrix3 rotation_vector_rate(const Vector3& v);

}  // namespace sinew
