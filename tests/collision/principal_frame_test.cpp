#include "sinew/collision/principal_frame.hpp"

#include <random>
#include <variant>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace sinew::collision {
namespace {

using Smooth = std::variant<Plane, Sphere, Capsule>;

TEST(PrincipalFrame, IsThatOfTheSecondDerivative) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> coordinate(-0.1, 0.1);
  const std::vector<Smooth> shapes{Plane{{0.1, -0.2, 0.05}, Vector3(0.3, -0.4, 0.8).normalized()},
                                   Sphere{{0.02, 0.01, -0.03}, 0.02},
                                   Capsule{{-0.01, 0.0, 0.0}, {0.03, 0.02, -0.01}, 0.005}};
  constexpr double kStep = 1e-7;
  for (const Smooth& surface : shapes) {
    for (int trial = 0; trial < 100; ++trial) {
      const Vector3 at(coordinate(random), coordinate(random), coordinate(random));
      const PrincipalFrame principal = principal_frame(surface, at);
      const Matrix3& frame = principal.frame;
      EXPECT_LT((frame.transpose() * frame - Matrix3::Identity()).norm(), 1e-12);
      EXPECT_LT((frame.col(0) - distance(surface, at).normal).norm(), 1e-12);
      const Matrix3 second = frame * principal.curvature.asDiagonal() * frame.transpose();
      for (int k = 0; k < 3; ++k) {
        const Vector3 step = kStep * Vector3::Unit(k);
        const Vector3 turn =
            (distance(surface, at + step).normal - distance(surface, at - step).normal) /
            (2.0 * kStep);
        EXPECT_LT((turn - second.col(k)).norm(), 1e-5 * (1.0 + turn.norm()));
      }
    }
  }
}

TEST(TangentFrame, IsOrthonormal) {
  std::mt19937 random(5);
  std::normal_distribution<double> number;
  for (int trial = 0; trial < 200; ++trial) {
    Vector3 normal = Vector3(number(random), number(random), number(random)).normalized();
    if (trial == 0) normal = Vector3::UnitZ();
    if (trial == 1) normal = -Vector3::UnitZ();
    const Matrix3 frame = tangent_frame(normal);
    EXPECT_LT((frame.transpose() * frame - Matrix3::Identity()).norm(), 1e-14);
    EXPECT_NEAR(frame.determinant(), 1.0, 1e-14);
    EXPECT_EQ(frame.col(0), normal);
  }
}

}  // namespace
}  // namespace sinew::collision
