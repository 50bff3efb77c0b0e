#include "sinew/linalg/positive_part.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "sinew/core/random.hpp"

namespace sinew::linalg {
namespace {

TEST(PositivePart, KeepsPositiveEigenpairsAndDropsTheOthers) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    Matrix3 m;
    for (int i = 0; i < 9; ++i) m.data()[i] = random.uniform(-1.0, 1.0);
    m = (m + m.transpose()).eval();
    const Matrix3 part = positive_part(m);
    const Eigen::SelfAdjointEigenSolver<Matrix3> left(part), rest(part - m);
    EXPECT_GE(left.eigenvalues().minCoeff(), -1e-14);
    EXPECT_GE(rest.eigenvalues().minCoeff(), -1e-14);             // not below the matrix
    EXPECT_LE((part * (part - m)).cwiseAbs().maxCoeff(), 1e-14);  // and the nearest such matrix
  }
}

}  // namespace
}  // namespace sinew::linalg
