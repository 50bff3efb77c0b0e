#include "sinew/qp/bordered_factor.hpp"

#include <limits>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace sinew::qp {
namespace {

MatrixX random_matrix(int rows, int columns, std::mt19937_64& engine) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  MatrixX made(rows, columns);
  for (double& value : made.reshaped()) value = number(engine);
  return made;
}

// A matrix whose leading block is symmetric with eigenvalues of at least one; the rest is
// unsymmetric.
MatrixX random_case(int leading, int rest, std::mt19937_64& engine) {
  MatrixX a = random_matrix(leading + rest, leading + rest, engine);
  const MatrixX root = random_matrix(leading, leading, engine);
  a.topLeftCorner(leading, leading) = root * root.transpose();
  a.diagonal().head(leading).array() += 1.0;
  return a;
}

void fill(BorderedFactor& factor, const MatrixX& a, int leading) {
  const int rest = static_cast<int>(a.rows()) - leading;
  factor.reshape(leading, rest);
  factor.leading() = a.topLeftCorner(leading, leading);
  // Entries above the diagonal are not read.
  factor.leading().triangularView<Eigen::StrictlyUpper>().setConstant(
      std::numeric_limits<double>::quiet_NaN());
  factor.left() = a.bottomLeftCorner(rest, leading);
  factor.right() = a.topRightCorner(leading, rest).transpose();
  factor.corner() = a.bottomRightCorner(rest, rest);
}

// One factor for all sizes, which would reveal remains of a larger matrix. Sizes 97 and 200 need
// more than one panel.
TEST(BorderedFactor, SolvesAsLuDoes) {
  std::mt19937_64 engine(3);
  BorderedFactor factor;
  for (const int leading : {200, 0, 1, 2, 3, 8, 96, 97, 130}) {
    for (const int rest : {0, 1, 2, 3, 7, 40}) {
      if (leading + rest == 0) continue;
      const MatrixX a = random_case(leading, rest, engine);
      const VectorX b = random_matrix(leading + rest, 1, engine);
      fill(factor, a, leading);
      ASSERT_TRUE(factor.factorise()) << leading << " and " << rest;
      const VectorX expected = a.partialPivLu().solve(b);
      for (int again = 0; again < 2; ++again) {  // solving does not change the factors
        VectorX x = b;
        factor.solve(x);
        // Both errors are bounded by the condition number of A, about 1e4 here.
        EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm()) << leading << " and " << rest;
      }
    }
  }
}

TEST(BorderedFactor, RefusesWhatIsNotPositiveDefinite) {
  std::mt19937_64 engine(5);
  BorderedFactor factor;
  for (const int row : {0, 50, 119}) {  // in the first and the last panel
    MatrixX a = random_case(120, 4, engine);
    a(row, row) = -1.0;
    fill(factor, a, 120);
    EXPECT_FALSE(factor.factorise()) << row;
    a.col(row).head(120).setZero();
    a.row(row).head(120).setZero();
    fill(factor, a, 120);
    EXPECT_FALSE(factor.factorise()) << row << ", singular";
    fill(factor, a, 0);
    EXPECT_TRUE(factor.factorise()) << row << ": the whole by LU";
  }
}

TEST(BorderedFactor, RefusesASingularRest) {
  std::mt19937_64 engine(7);
  BorderedFactor factor;
  MatrixX a = random_case(9, 3, engine);
  a.row(10).setZero();
  fill(factor, a, 9);
  EXPECT_FALSE(factor.factorise());
}

}  // namespace
}  // namespace sinew::qp
