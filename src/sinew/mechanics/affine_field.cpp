#include "sinew/mechanics/affine_field.hpp"

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"

namespace sinew::mechanics {

AffineField rigid_displacement(const Vector3& translation, const Vector3& rotation,
                               const Vector3& centre) {
  if (!translation.allFinite() || !rotation.allFinite() || !centre.allFinite()) {
    throw Error(ErrorKind::not_finite, {.item = "base"}, "a number is not finite",
                "give a translation (m), a rotation vector (rad) and a centre (m)");
  }
  const Matrix3 turn = rotation_matrix(rotation) - Matrix3::Identity();
  AffineField displacement;
  displacement << turn, translation - turn * centre;
  return displacement;
}

}  // namespace sinew::mechanics
