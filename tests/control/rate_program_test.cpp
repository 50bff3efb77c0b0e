// The program of a closed loop's step, against the pseudo-inverse and against other choices.
#include "sinew/control/rate_program.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace sinew::control {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

struct Case {
  explicit Case(unsigned seed) : random(seed) {
    const MatrixX root = matrix(7, 4);
    w_aa = root.transpose() * root;
    w_ea = matrix(3, 4);
    limits = {VectorX::Constant(4, 1.0),
              VectorX::Zero(4),
              VectorX::Constant(4, -kInf),
              VectorX::Constant(4, kInf),
              VectorX::Constant(4, -kInf),
              VectorX::Constant(4, kInf),
              VectorX::Ones(4)};
  }
  MatrixX matrix(int rows, int columns) {
    std::normal_distribution<double> normal;
    return MatrixX::NullaryExpr(rows, columns, [&] { return normal(random); });
  }
  double missed(const VectorX& change, const VectorX& wanted, const VectorX& weights) const {
    const VectorX left = w_ea * change - wanted;
    return left.dot(weights.cwiseProduct(left));
  }

  std::mt19937 random;
  MatrixX w_ea, w_aa;
  RateLimits limits;
};

// With more actuators than task directions, the change is the one of least energy among all that
// achieve the task.
TEST(RateProgram, WithoutLimitsIsThePseudoInverse) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Case one(seed);
    one.limits.effort.setZero();
    const VectorX wanted = one.matrix(3, 1);
    const RateChoice choice =
        choose_change(one.w_ea, one.w_aa, wanted, VectorX::Ones(3), one.limits);
    const MatrixX inverse = one.w_aa.inverse();
    const VectorX expected = inverse * one.w_ea.transpose() *
                             (one.w_ea * inverse * one.w_ea.transpose()).inverse() * wanted;
    EXPECT_LT((choice.change - expected).norm(), 2e-2 * expected.norm()) << seed;
    EXPECT_LT((one.w_ea * choice.change - wanted).norm(), 2e-2 * wanted.norm()) << seed;
    EXPECT_FALSE(choice.limited);
    EXPECT_FALSE(choice.conflict);
  }
}

TEST(RateProgram, WithinLimitsNoOtherChoiceIsBetter) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Case one(seed);
    one.limits.effort_min.setConstant(0.8);
    one.limits.effort_max.setConstant(1.3);
    one.limits.motion_max.setConstant(0.4);
    const VectorX wanted = 2.0 * one.matrix(3, 1);
    const VectorX weights = one.matrix(3, 1).cwiseAbs();
    const RateChoice choice = choose_change(one.w_ea, one.w_aa, wanted, weights, one.limits);
    EXPECT_TRUE(choice.limited);
    EXPECT_FALSE(choice.conflict);
    EXPECT_GE(choice.change.minCoeff(), -0.2 - 1e-9);
    EXPECT_LE(choice.change.maxCoeff(), 0.3 + 1e-9);
    EXPECT_LE((one.w_aa * choice.change).maxCoeff(), 0.4 + 1e-9);
    const double found = one.missed(choice.change, wanted, weights);
    std::uniform_real_distribution<double> within(-0.2, 0.3);
    for (int k = 0; k < 2000; ++k) {
      const VectorX other = VectorX::NullaryExpr(4, [&] { return within(one.random); });
      if ((one.w_aa * other).maxCoeff() > 0.4) continue;
      EXPECT_GT(one.missed(other, wanted, weights), (1.0 - 1e-3) * found) << seed;
    }
  }
}

// Effort limits take priority over motion limits.
TEST(RateProgram, EffortsComeBeforeMotions) {
  Case one(3);
  one.limits.effort.setConstant(2.0);
  one.limits.effort_max.setConstant(1.0);
  one.limits.motion_min.setConstant(-1e-3);
  const RateChoice choice =
      choose_change(one.w_ea, one.w_aa, VectorX::Zero(3), VectorX::Ones(3), one.limits);
  EXPECT_TRUE(choice.conflict);
  EXPECT_LE(choice.change.maxCoeff(), -1.0 + 1e-9);
}

}  // namespace
}  // namespace sinew::control
