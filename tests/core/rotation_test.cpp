#include "sinew/core/rotation.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace sinew {
namespace {

// Compares with cos(a/2) and sin(a/2) of the axis; beyond half a turn the sign is reversed.
TEST(UnitQuaternion, HasAScalarPartThatIsNotNegative) {
  for (const Vector3& axis :
       {Vector3(1, 0, 0), Vector3(0, -1, 0), Vector3(0, 0, 1), Vector3(-0.48, 0.6, -0.64)}) {
    for (double angle = 0.1; angle < 6.2; angle += 0.2) {
      const Eigen::Vector4d found = unit_quaternion(rotation_matrix(angle * axis));
      const double sign = std::cos(0.5 * angle) < 0.0 ? -1.0 : 1.0;
      EXPECT_GE(found[0], 0.0) << angle;
      EXPECT_NEAR(found[0], sign * std::cos(0.5 * angle), 1e-14);
      EXPECT_LT((found.tail<3>() - sign * std::sin(0.5 * angle) * axis).norm(), 1e-14) << angle;
    }
  }
}

}  // namespace
}  // namespace sinew
