#include "sinew/core/rotation.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace sinew {

namespace {

// Below this angle the factor of [v]^2 is its series, 1/12 + a^2/720: the next term is rounding.
constexpr double kSmallAngle = 1e-3;

}  // namespace

Matrix3 rotation_matrix(const Vector3& v) {
  const double angle = v.norm();
  if (angle == 0.0) return Matrix3::Identity();
  return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

Points moved(const Points& points, const Matrix3& rotation, const Vector3& displacement) {
  return (points * rotation.transpose()).rowwise() + displacement.transpose();
}

Vector3 rotation_vector(const Matrix3& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Eigen::Vector4d unit_quaternion(const Matrix3& rotation) {
  const Eigen::Quaterniond turn(rotation);
  const double sign = turn.w() < 0.0 ? -1.0 : 1.0;
  return sign * Eigen::Vector4d(turn.w(), turn.x(), turn.y(), turn.z());
}

Matrix3 rotation_vector_rate(const Vector3& v) {
  const double angle = v.norm();
  const double factor = angle < kSmallAngle
                            ? 1.0 / 12.0 + angle * angle / 720.0
                            : 1.0 / (angle * angle) - 1.0 / (2.0 * angle * std::tan(0.5 * angle));
  const Matrix3 cross = cross_matrix(v);
  return Matrix3::Identity() - 0.5 * cross + factor * cross * cross;
}

}  // namespace sinew
