/// One test suite for every law: energy -> stress -> tangent.
#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "sinew/material/response.hpp"

#include "lane_matrices.hpp"

namespace sinew::material {
namespace {

constexpr double kMu = 1.3, kLambda = 4.1;

template <Law law>
struct Tested {
  static Response at(const Matrix3& f) { return respond<law>(broadcast(f), moduli()); }
  static LaneModuli moduli() { return {lanes(kMu), lanes(kLambda)}; }
  static double energy(const Matrix3& f) { return at(f).energy[3]; }
  static Matrix3 stress(const Matrix3& f) { return lane_of(at(f).stress, 3); }

  /// dP for dF = u b^T.
  static Matrix3 exact(const Matrix3& f, const Vector3& u, const Vector3& b) {
    const Response response = at(f);
    const ExactTangent tangent = exact_tangent<law>(broadcast(f), moduli(), response);
    const LanesSymmetric& s = tangent.g;
    Matrix3 g;
    g << s.xx[3], s.xy[3], s.xz[3], s.xy[3], s.yy[3], s.yz[3], s.xz[3], s.yz[3], s.zz[3];
    const Matrix3 r = lane_of(response.rotation, 3);
    Matrix3 result;
    for (int k = 0; k < 3; ++k) {
      const Vector3 a = Vector3::Unit(k), ra = r * a, rb = r * b;
      result.col(k) = 2.0 * kMu * a.dot(b) * u + kLambda * ra * rb.dot(u) +
                      tangent.kappa[3] * (ra.dot(g * rb) * (g * u) - g * rb * (g * ra).dot(u));
    }
    return result;
  }
};

template <typename T>
class EveryLaw : public testing::Test {};
using Laws = testing::Types<Tested<Law::linear>, Tested<Law::corotational>>;
TYPED_TEST_SUITE(EveryLaw, Laws);

TYPED_TEST(EveryLaw, StressIsTheDerivativeOfTheEnergy) {
  constexpr double kStep = 1e-5;
  for (const auto& [name, f] : deformation_gradients()) {
    const Matrix3 stress = TypeParam::stress(f);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        const Matrix3 step = kStep * Vector3::Unit(r) * Vector3::Unit(c).transpose();
        const double difference =
            (TypeParam::energy(f + step) - TypeParam::energy(f - step)) / (2.0 * kStep);
        EXPECT_NEAR(stress(r, c), difference, 2e-8 * (1.0 + stress.norm())) << name;
      }
    }
  }
}

TYPED_TEST(EveryLaw, ExactTangentIsTheDerivativeOfTheStress) {
  constexpr double kStep = 1e-5;
  for (const auto& [name, f] : deformation_gradients()) {
    // The third derivatives grow as the inverse square of the sum of the two smallest stretches.
    const double stiff = 1.0 / std::min(1.0, TypeParam::at(f).pair_sums[3]);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        const Vector3 u = Vector3::Unit(r), b = Vector3::Unit(c);
        const Matrix3 step = kStep * u * b.transpose();
        const Matrix3 difference =
            (TypeParam::stress(f + step) - TypeParam::stress(f - step)) / (2.0 * kStep);
        const Matrix3 tangent = TypeParam::exact(f, u, b);
        EXPECT_LT((tangent - difference).norm(), 1e-8 * (1.0 + tangent.norm()) * stiff * stiff)
            << name << "\n"
            << tangent << "\n\n"
            << difference;
      }
    }
  }
}

TYPED_TEST(EveryLaw, IsAtRestInTheReferenceState) {
  EXPECT_NEAR(TypeParam::energy(Matrix3::Identity()), 0.0, 1e-28);
  EXPECT_LT(TypeParam::stress(Matrix3::Identity()).norm(), 1e-14);
}

TYPED_TEST(EveryLaw, AgreesWithHookesLawForSmallStrain) {
  RandomMatrices random;
  const Matrix3 gradient = random.entries(1e-6);
  const Matrix3 strain = 0.5 * (gradient + gradient.transpose());
  const Matrix3 hooke = 2.0 * kMu * strain + kLambda * strain.trace() * Matrix3::Identity();
  EXPECT_LT((TypeParam::stress(Matrix3::Identity() + gradient) - hooke).norm(),
            1e-5 * hooke.norm());
}

using Corotational = Tested<Law::corotational>;

TEST(CorotationalLaw, TurnsWithTheBody) {
  RandomMatrices random;
  for (const auto& [name, f] : deformation_gradients()) {
    const Matrix3 turn = random.rotation();
    EXPECT_LT((Corotational::stress(turn * f) - turn * Corotational::stress(f)).norm(), 1e-12)
        << name;
    EXPECT_NEAR(Corotational::energy(turn * f), Corotational::energy(f), 1e-12) << name;
  }
}

TEST(CorotationalLaw, HasNoStressUnderRotation) {
  RandomMatrices random;
  for (int k = 0; k < 200; ++k) {
    EXPECT_LT(Corotational::stress(random.rotation()).norm(), 1e-13);
  }
}

/// psi = mu sum (s_i - 1)^2 + lambda/2 (sum s_i - 3)^2, computed by hand for one triple of
/// stretches.
TEST(CorotationalLaw, EnergyOfKnownStretches) {
  RandomMatrices random;
  const Matrix3 f = random.with_stretches(1.5, 1.0, 0.8);
  EXPECT_NEAR(Corotational::energy(f), kMu * (0.25 + 0.04) + 0.5 * kLambda * 0.09, 1e-13);
  const Matrix3 inverted = random.with_stretches(1.5, 1.0, -0.5);
  EXPECT_NEAR(Corotational::energy(inverted), kMu * (0.25 + 2.25) + 0.5 * kLambda * 1.0, 1e-12);
}

/// An inverted element is pushed back: the energy decreases as the smallest stretch increases.
TEST(CorotationalLaw, PushesInvertedElementsBack) {
  RandomMatrices random;
  const Matrix3 q = random.rotation(), w = random.rotation();
  const Matrix3 f = q * Vector3(1.0, 1.0, -0.5).asDiagonal() * w.transpose();
  const Matrix3 direction = q * Vector3(0.0, 0.0, 1.0).asDiagonal() * w.transpose();
  EXPECT_LT(Corotational::stress(f).cwiseProduct(direction).sum(), 0.0);
}

TEST(LinearLaw, VolumeRatioIsThatOfTheDeformation) {
  const Matrix3 f = Vector3(2.0, 0.5, 0.3).asDiagonal();
  EXPECT_DOUBLE_EQ(Tested<Law::linear>::at(f).determinant[0], 0.3);
}

}  // namespace
}  // namespace sinew::material
