#include "sinew/mechanics/affine_field.hpp"

#include <Eigen/Geometry>

#include "sinew/core/error.hpp"

namespace sinew::mechanics {

AffineField rigid_displacement(const Vector3& translation, const Vector3& rotation,
                               const Vector3& centre) {
  if (!translation.allFinite() || !rotation.allFinite() || !centre.allFinite()) {
    throw Error(ErrorKind::not_finite, {.item = "base"}, "a number is not finite",
                "give a translation (m), a rotation vector (rad) and a centre (m)");
  }
  const double angle = rotation.norm();
  Matrix3 turn = Matrix3::Zero();  // R - I
  if (angle > 0.0) {
    turn = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix() - Matrix3::Identity();
  }
  AffineField displacement;
  displacement << turn, translation - turn * centre;
  return displacement;
}

}  // namespace sinew::mechanics
