#include "sinew/linalg/dense.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "sinew/linalg/dense_factor.hpp"

namespace sinew::linalg {
namespace {

MatrixX random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> between(-1.0, 1.0);
  return MatrixX::NullaryExpr(rows, columns, [&] { return between(random); });
}

MatrixX symmetric(Eigen::Index size, unsigned seed) {
  const MatrixX a = random_matrix(size, size, seed);
  return a + a.transpose();
}

// Rounding of sums of up to 300 products of numbers near one.
constexpr double kRounding = 1e-12;

TEST(Dense, EigenvaluesAndVectorsDiagonalise) {
  for (const Eigen::Index n : {1, 2, 3, 7, 40}) {
    const MatrixX a = symmetric(n, 3);
    const SymmetricSpectrum spectrum(a);
    const MatrixX& v = spectrum.vectors();
    EXPECT_LT((v.transpose() * v - MatrixX::Identity(n, n)).norm(), kRounding) << n;
    EXPECT_LT((a * v - v * spectrum.values().asDiagonal()).norm(), kRounding) << n;
    EXPECT_LT((symmetric_eigenvalues(a) - spectrum.values()).norm(), kRounding) << n;
    EXPECT_NEAR(spectrum.values().sum(), a.trace(), kRounding) << n;
    for (Eigen::Index k = 1; k < n; ++k) EXPECT_LE(spectrum.values()[k - 1], spectrum.values()[k]);
  }
}

TEST(Dense, EigenvaluesReadTheLowerTriangleAlone) {
  MatrixX a = symmetric(5, 4);
  const VectorX values = symmetric_eigenvalues(a);
  a.triangularView<Eigen::StrictlyUpper>().setConstant(99.0);
  EXPECT_EQ(symmetric_eigenvalues(a), values);
}

TEST(Dense, SingularVectorsComeThinAndFull) {
  for (const auto& [rows, columns] : {std::pair(3, 8), std::pair(8, 3), std::pair(30, 60)}) {
    const MatrixX a = random_matrix(rows, columns, 5);
    const Eigen::Index least = std::min(rows, columns);
    const Svd thin_u = svd(a, SingularVectors::thin_u), thin_v = svd(a, SingularVectors::thin_v);
    const Svd full_u = svd(a, SingularVectors::full_u), full_v = svd(a, SingularVectors::full_v);
    EXPECT_EQ(thin_u.u.cols(), least);
    EXPECT_EQ(thin_u.v.size(), 0);
    EXPECT_EQ(thin_v.v.cols(), least);
    EXPECT_EQ(full_u.u.cols(), rows);
    EXPECT_EQ(full_v.v.cols(), columns);
    // A^T u = s v and A v = s u, so |A^T u| = |A v| = s. The other columns of a full basis span the
    // null space.
    for (Eigen::Index k = 0; k < least; ++k) {
      EXPECT_NEAR((a.transpose() * thin_u.u.col(k)).norm(), thin_u.values[k], kRounding);
      EXPECT_NEAR((a * thin_v.v.col(k)).norm(), thin_v.values[k], kRounding);
    }
    EXPECT_LT((a.transpose() * full_u.u.rightCols(rows - least)).norm(), kRounding);
    EXPECT_LT((a * full_v.v.rightCols(columns - least)).norm(), kRounding);
    EXPECT_LT((full_v.v.transpose() * full_v.v - MatrixX::Identity(columns, columns)).norm(),
              kRounding);
    EXPECT_LT((singular_values(a) - thin_u.values).norm(), kRounding);
    EXPECT_NEAR(thin_u.values.squaredNorm(), a.squaredNorm(), kRounding * a.squaredNorm());
  }
}

TEST(Dense, LeastSquaresLeavesAResidualAcrossTheColumns) {
  const MatrixX a = random_matrix(12, 4, 6), b = random_matrix(12, 3, 7);
  const LeastSquares found = least_squares(a, b);
  EXPECT_EQ(found.rank, 4);
  EXPECT_LT((a.transpose() * (a * found.x - b)).norm(), kRounding);
  MatrixX twice(12, 5);
  twice << a, a.col(1);
  EXPECT_EQ(least_squares(twice, b).rank, 4) << "a column comes twice";
}

TEST(Dense, UpperFactorIsACholeskyFactorOfTheProducts) {
  const MatrixX a = random_matrix(20, 6, 8), r = upper_factor(a);
  EXPECT_LT((r.transpose() * r - a.transpose() * a).norm(), kRounding);
  EXPECT_TRUE(r.isUpperTriangular(0.0));
}

// Penrose's four conditions, rank-deficient matrices included.
TEST(Dense, PseudoInverse) {
  MatrixX a = random_matrix(7, 4, 9);
  for (const bool deficient : {false, true}) {
    if (deficient) a.col(2) = a.col(0) - 2.0 * a.col(1);
    const MatrixX p = pseudo_inverse(a);
    EXPECT_LT((a * p * a - a).norm(), kRounding);
    EXPECT_LT((p * a * p - p).norm(), kRounding);
    EXPECT_LT((a * p - (a * p).transpose()).norm(), kRounding);
    EXPECT_LT((p * a - (p * a).transpose()).norm(), kRounding);
  }
}

TEST(Dense, SolvesSquareSystems) {
  const MatrixX a = random_matrix(9, 9, 10), b = random_matrix(9, 2, 11);
  EXPECT_LT((a * solve(a, b) - b).norm(), kRounding);
  const MatrixX s = symmetric(9, 12) - 40.0 * MatrixX::Identity(9, 9);  // negative definite
  EXPECT_LT((s * solve_symmetric(s, b) - b).norm(), kRounding);
  EXPECT_FALSE(solve(MatrixX::Zero(3, 3), MatrixX::Ones(3, 1)).allFinite());
}

TEST(DenseFactor, SolvesVectorsAndColumns) {
  const MatrixX a = random_matrix(6, 6, 13), b = random_matrix(6, 4, 14);
  const MatrixX spd = a * a.transpose() + MatrixX::Identity(6, 6);
  LuFactor lu(6);
  CholeskyFactor cholesky(6);
  lu.compute(a);
  ASSERT_TRUE(cholesky.compute(spd));
  MatrixX x(6, 4);
  VectorX y = b.col(1);
  lu.solve_columns(b, x);
  EXPECT_LT((a * x - b).norm(), kRounding);
  lu.solve(VectorX(b.col(1)), y);
  EXPECT_LT((a * y - b.col(1)).norm(), kRounding);
  cholesky.solve_columns(b, x);
  EXPECT_LT((spd * x - b).norm(), kRounding);
  y = b.col(2);
  cholesky.solve(y, y);
  EXPECT_LT((spd * y - b.col(2)).norm(), kRounding);
  EXPECT_FALSE(cholesky.compute(-spd));
}

TEST(DenseFactor, PivotsTellTheInertia) {
  const MatrixX v = SymmetricSpectrum(symmetric(6, 15)).vectors();
  VectorX values(6);
  values << -3.0, -1e-3, 2.0, 1e-2, -0.5, 7.0;
  SymmetricPivots pivots(6);
  pivots.compute(v * values.asDiagonal() * v.transpose());
  EXPECT_EQ(pivots.negative(), 3);
  EXPECT_FALSE(pivots.vanishes());
  pivots.compute(MatrixX::Zero(6, 6));
  EXPECT_EQ(pivots.negative(), 0);
  EXPECT_TRUE(pivots.vanishes());
}

}  // namespace
}  // namespace sinew::linalg
