#include "sinew/mechanics/affine_field.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

namespace sinew::mechanics {
namespace {

TEST(AffineField, IsTheDisplacementOfARigidMotion) {
  const Vector3 shift(0.1, -0.2, 0.3), turn(0.4, 0.7, -1.1), centre(0.5, 0.1, -0.3);
  const AffineField field = rigid_displacement(shift, turn, centre);
  const Matrix3 rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  for (const Vector3& rest : {Vector3(0.0, 0.0, 0.0), Vector3(1.0, -2.0, 0.5), centre}) {
    const Vector3 moved = centre + rotation * (rest - centre) + shift;
    EXPECT_LT((value_at(field, rest) - (moved - rest)).norm(), 1e-15);
  }
  EXPECT_LT((value_at(field, centre) - shift).norm(), 1e-15);
}

// Displacements of small turns are exact to the rounding of positions, eps times the lever.
TEST(AffineField, OfSmallTurnsKeepTheRoundingOfPositions) {
  for (const double angle : {1e-4, 1e-8, 1e-12, 0.0}) {
    const AffineField field =
        rigid_displacement(Vector3::Zero(), angle * Vector3::UnitZ(), Vector3::Zero());
    const Vector3 moved = value_at(field, Vector3::UnitX());
    EXPECT_NEAR(moved.x(), -2.0 * std::pow(std::sin(angle / 2.0), 2), 1.2e-16);
    EXPECT_NEAR(moved.y(), std::sin(angle), 1e-15 * angle);
  }
}

TEST(AffineField, OfAFullTurnIsZero) {
  const AffineField field = rigid_displacement(
      Vector3::Zero(), 2.0 * std::numbers::pi * Vector3::UnitY(), Vector3(1.0, 2.0, 3.0));
  EXPECT_LT(field.cwiseAbs().maxCoeff(), 1e-14);
}

TEST(AffineField, RefusesWhatIsNotFinite) {
  const Vector3 bad(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0), good = Vector3::Zero();
  for (const int which : {0, 1, 2}) {
    try {
      rigid_displacement(which == 0 ? bad : good, which == 1 ? bad : good, which == 2 ? bad : good);
      ADD_FAILURE() << which;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::not_finite);
    }
  }
}

}  // namespace
}  // namespace sinew::mechanics
