#include "sinew/linalg/gmres.hpp"

#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace sinew::linalg {
namespace {

constexpr int kSize = 40;

// The unit matrix plus an unsymmetric part of rank 6.
MatrixX near_unit() {
  const auto wave = [](double rate) {
    return MatrixX(MatrixX::NullaryExpr(kSize, 6, [=](Eigen::Index i, Eigen::Index j) {
      return std::sin(rate * static_cast<double>((i + 1) * (j + 2)));
    }));
  };
  return MatrixX::Identity(kSize, kSize) + 0.3 * wave(0.7) * wave(1.3).transpose();
}

Gmres::Operator times(const MatrixX& a) {
  return [&a](const Eigen::Ref<const VectorX>& x, Eigen::Ref<VectorX> y) { y.noalias() = a * x; };
}

TEST(Gmres, TakesAsManyDirectionsAsTheRankOfWhatIsNotUnit) {
  const MatrixX a = near_unit();
  const VectorX b = VectorX::LinSpaced(kSize, -1.0, 2.0);
  VectorX x = b;
  EXPECT_LT(Gmres(7, 1e-14).solve(times(a), x), 1e-12);
  EXPECT_LT((x - a.partialPivLu().solve(b)).norm(), 1e-10 * x.norm());
}

TEST(Gmres, SaysWhatItLeaves) {
  const MatrixX a = near_unit();
  const VectorX b = VectorX::LinSpaced(kSize, -1.0, 2.0);
  Gmres solver(3, 1e-14);
  for (int again = 0; again < 2; ++again) {
    VectorX x = b;
    const double left = solver.solve(times(a), x);
    EXPECT_GT(left, 1e-6);
    EXPECT_NEAR(left, (a * x - b).norm() / b.norm(), 1e-12);
  }
}

TEST(Gmres, LeavesNothingOfNothing) {
  const MatrixX a = near_unit();
  VectorX x = VectorX::Zero(kSize);
  EXPECT_EQ(Gmres(3, 1e-14).solve(times(a), x), 0.0);
  EXPECT_TRUE(x.isZero(0.0));
}

TEST(Gmres, FindsNothingWhereNothingIsToBeFound) {
  const MatrixX zero = MatrixX::Zero(kSize, kSize);
  VectorX x = VectorX::Ones(kSize);
  EXPECT_EQ(Gmres(3, 1e-14).solve(times(zero), x), 1.0);
  EXPECT_TRUE(x.isZero(0.0));
  x.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(std::isnan(Gmres(3, 1e-14).solve(times(zero), x)));
}

}  // namespace
}  // namespace sinew::linalg
