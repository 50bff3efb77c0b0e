// Actuator lengths along a bent segment, and the inverse mapping.
#include "sinew/pcc/actuator_lengths.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/arm_equations.hpp"

#include "arms.hpp"

namespace sinew::pcc {
namespace {

VectorX round_the_axis(int count) {
  return VectorX::LinSpaced(count, 0.3, 0.3 + 2.0 * std::numbers::pi * (count - 1) / count);
}

TEST(ActuatorLengths, AreThoseOfCurvesAlongTheSegment) {
  ArmSettings settings = testing::fluidic();
  settings.segments.resize(1);
  settings.segments[0].bending = Bending::spatial;
  settings.segments[0].extensible = true;
  settings.segments[0].axial_stiffness = 1.0;
  ArmEquations equations(testing::make(settings));
  const VectorX q{{0.9, -0.6, 0.02}}, still = VectorX::Zero(3), angles = round_the_axis(4);
  const double radius = 0.018;
  const VectorX lengths = actuator_lengths({q[0], q[1], 0.14 + q[2]}, radius, angles);
  constexpr int kPieces = 2000;
  for (Eigen::Index i = 0; i < angles.size(); ++i) {
    double sum = 0.0;
    Vector3 before;
    for (int k = 0; k <= kPieces; ++k) {
      const Vector3 x =
          equations
              .point({0, static_cast<double>(k) / kPieces, radius * std::cos(angles[i]),
                      radius * std::sin(angles[i]), 0.0},
                     q, still)
              .position;
      if (k > 0) sum += (x - before).norm();
      before = x;
    }
    EXPECT_NEAR(lengths[i], sum, 1e-8);
  }
}

TEST(ActuatorLengths, GiveTheBendBack) {
  for (const int count : {3, 4, 7}) {
    const VectorX angles = round_the_axis(count);
    const Bent bent =
        bend_of_lengths(actuator_lengths({0.7, -1.2, 0.2}, 0.01, angles), 0.01, angles);
    EXPECT_NEAR(bent.u, 0.7, 1e-12);
    EXPECT_NEAR(bent.v, -1.2, 1e-12);
    EXPECT_NEAR(bent.length, 0.2, 1e-13);
  }
  EXPECT_THROW(bend_of_lengths(VectorX::Ones(2), 0.01, VectorX::Zero(2)), Error);
  EXPECT_THROW(bend_of_lengths(VectorX::Ones(3), 0.0, round_the_axis(3)), Error);
  EXPECT_THROW(bend_of_lengths(VectorX::Ones(4), 0.01, VectorX::Zero(4)), Error);
}

}  // namespace
}  // namespace sinew::pcc
