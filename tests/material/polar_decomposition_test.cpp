#include "sinew/material/polar_decomposition.hpp"

#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "lane_matrices.hpp"

namespace sinew::material {
namespace {

struct Reference {
  Matrix3 rotation;
  Vector3 stretches;  // the last with the sign of det F
};

Reference reference(const Matrix3& f) {
  const Eigen::JacobiSVD<Matrix3> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 u = svd.matrixU();
  Vector3 s = svd.singularValues();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) {
    u.col(2) *= -1.0;
    s[2] *= -1.0;
  }
  return {u * svd.matrixV().transpose(), s};
}

double pair_sums(const Vector3& s) { return (s[0] + s[1]) * (s[1] + s[2]) * (s[2] + s[0]); }

/// A matrix of one of several kinds, from benign to crushed and inverted.
Matrix3 sample(int kind, RandomMatrices& random) {
  const auto tiny = [&] { return std::pow(10.0, 4.0 * random.uniform() - 4.0); };
  switch (kind) {
    case 0:
      return random.rotation() * (Matrix3::Identity() + random.entries(0.05));
    case 1:
      return random.entries(2.0);
    case 2:
      return random.with_stretches(1.0, 0.8, tiny());
    case 3:
      return random.with_stretches(1.0, tiny(), tiny());
    case 4:
      return random.with_stretches(1.0, 0.7, -0.7 * std::abs(random.uniform()));
    case 5:
      return 1e-6 * random.entries(1.0);
    case 6:
      return 1e6 * random.entries(1.0);
    default:
      return random.with_stretches(1.0, 1.0, 1.0 + 1e-9 * random.uniform());
  }
}

TEST(PolarDecomposition, AgreesWithSingularValuesOnManyMatrices) {
  RandomMatrices random;
  double worst = 0.0, worst_scaled = 0.0;
  for (int batch = 0; batch < 20000; ++batch) {
    Lanes3x3 f;
    Matrix3 given[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
      given[lane] = sample(lane, random);
      set_lane(f, lane, given[lane]);
    }
    const PolarDecomposition polar = polar_decomposition(f);
    for (int lane = 0; lane < kLanes; ++lane) {
      const Reference expected = reference(given[lane]);
      const Matrix3 r = lane_of(polar.rotation, lane);
      const double size = expected.stretches[0];
      // Condition of the rotation: it changes by the change of F over the sum of the two smallest
      // stretches.
      const double gap = (expected.stretches[1] + expected.stretches[2]) / size;
      if (gap < 1e-9) continue;
      const double error = (r - expected.rotation).norm();
      worst = std::max(worst, (r.transpose() * r - Matrix3::Identity()).norm());
      worst_scaled = std::max(worst_scaled, error * std::min(gap, 1.0));
      ASSERT_NEAR(polar.trace[lane], expected.stretches.sum(), 1e-12 * size) << given[lane];
      ASSERT_NEAR(polar.pair_sums[lane], pair_sums(expected.stretches), 1e-11 * size * size * size);
      ASSERT_NEAR(polar.determinant[lane], given[lane].determinant(), 1e-14 * size * size * size);
      ASSERT_GT(r.determinant(), 0.0);
    }
  }
  RecordProperty("orthogonality", std::to_string(worst));
  EXPECT_LT(worst, 1e-10);
  EXPECT_LT(worst_scaled, 1e-12);
}

TEST(PolarDecomposition, IsExactAtModerateStretch) {
  RandomMatrices random;
  for (int k = 0; k < 2000; ++k) {
    const Matrix3 f = random.rotation() * (Matrix3::Identity() + random.entries(0.2));
    const PolarDecomposition polar = polar_decomposition(broadcast(f));
    ASSERT_LT((lane_of(polar.rotation, 5) - reference(f).rotation).norm(), 1e-14);
  }
}

/// Where R is not unique, the result is still a proper rotation with a symmetric R^T F.
TEST(PolarDecomposition, StaysProperWhereItIsNotUnique) {
  RandomMatrices random;
  const Matrix3 q = random.rotation(), w = random.rotation();
  const auto stretched = [&](double a, double b, double c) {
    return Matrix3(q * Vector3(a, b, c).asDiagonal() * w.transpose());
  };
  for (const Matrix3& f :
       {Matrix3(Matrix3::Zero()), stretched(1.0, 0.0, 0.0), stretched(1.0, 0.5, -0.5),
        stretched(1.0, 1.0, -1.0), stretched(-1.0, -1.0, -1.0), stretched(1e-200, 0.0, 0.0)}) {
    const PolarDecomposition polar = polar_decomposition(broadcast(f));
    const Matrix3 r = lane_of(polar.rotation, 0);
    EXPECT_LT((r.transpose() * r - Matrix3::Identity()).norm(), 1e-14);
    EXPECT_NEAR(r.determinant(), 1.0, 1e-14);
    const Matrix3 s = r.transpose() * f;
    EXPECT_LT((s - s.transpose()).norm(), 1e-14);
    EXPECT_EQ(r, lane_of(polar.rotation, 7));
  }
  EXPECT_EQ(lane_of(polar_decomposition(broadcast(Matrix3::Zero())).rotation, 0),
            Matrix3::Identity());
}

/// The rotation does not jump while a tetrahedron is inverted.
TEST(PolarDecomposition, IsContinuousThroughInversion) {
  RandomMatrices random;
  const Matrix3 q = random.rotation(), w = random.rotation();
  Matrix3 before = q * w.transpose();
  for (int k = 0; k <= 1000; ++k) {
    const double smallest = 1.0 - 0.0018 * k;  // down to -0.8
    const Matrix3 f = q * Vector3(1.1, 0.9, smallest).asDiagonal() * w.transpose();
    const Matrix3 r = lane_of(polar_decomposition(broadcast(f)).rotation, 2);
    ASSERT_LT((r - before).norm(), 1e-11) << smallest;
    before = r;
  }
}

/// Compares both sides of the switch to the singular value decomposition.
TEST(PolarDecomposition, TheFallbackMeetsTheClosedForm) {
  RandomMatrices random;
  for (int k = 0; k < 500; ++k) {
    const double gap = 0.002 + 4e-5 * k;
    const Matrix3 f = random.with_stretches(1.0, 0.4, gap - 0.4);
    const Matrix3 r = lane_of(polar_decomposition(broadcast(f)).rotation, 1);
    ASSERT_LT((r - reference(f).rotation).norm(), 2e-15 / (gap * gap));
  }
}

TEST(PolarDecomposition, ANanStaysInItsLane) {
  Lanes3x3 f = broadcast(Matrix3::Identity());
  f[1][2][3] = std::numeric_limits<double>::quiet_NaN();
  const PolarDecomposition polar = polar_decomposition(f);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(std::isnan(polar.rotation[0][0][lane]), lane == 3);
    EXPECT_EQ(std::isnan(polar.trace[lane]), lane == 3);
  }
}

TEST(PolarDecomposition, NeighbourLanesDoNotChangeARotationBeyondRounding) {
  RandomMatrices random;
  const Matrix3 f = Matrix3::Identity() + random.entries(0.1);
  Lanes3x3 mixed = broadcast(random.with_stretches(1.0, 0.02, -0.01));
  set_lane(mixed, 4, f);
  const Matrix3 alone = lane_of(polar_decomposition(broadcast(f)).rotation, 4);
  EXPECT_LT((lane_of(polar_decomposition(mixed).rotation, 4) - alone).norm(), 1e-15);
}

}  // namespace
}  // namespace sinew::material
