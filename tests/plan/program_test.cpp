// Small programs with known solutions, from distant and nearby starts.
#include <gtest/gtest.h>

#include "sinew/plan/interior_newton.hpp"

namespace sinew::plan {
namespace {

/// Problem 71 of Hock & Schittkowski (1981): min x1 x4 (x1 + x2 + x3) + x3, x1 x2 x3 x4 >= 25,
/// |x|^2 = 40, 1 <= x <= 5. The lower bound of the product can be chosen.
class Problem71 final : public NonlinearProgram {
 public:
  explicit Problem71(double least_product = 25.0) {
    variable_bounds_ = {VectorX::Constant(4, 1.0), VectorX::Constant(4, 5.0)};
    constraint_bounds_ = {VectorX{{least_product, 40.0}}, VectorX{{kNoBound, 40.0}}};
    // The solution must not depend on the scales.
    variable_scale_ = VectorX{{1.0, 2.0, 3.0, 0.5}};
    constraint_scale_ = VectorX{{10.0, 3.0}};
    objective_scale_ = 5.0;
    for (int row = 0; row < 2; ++row) {
      for (int j = 0; j < 4; ++j) jacobian_pattern_.push_back({row, j});
    }
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j <= i; ++j) hessian_pattern_.push_back({i, j});
    }
  }

  double objective(const VectorX& x) override { return x[0] * x[3] * x.head(3).sum() + x[2]; }
  void gradient(const VectorX& x, VectorX& g) override {
    const double sum = x.head(3).sum();
    g = VectorX{{x[3] * (sum + x[0]), x[0] * x[3], x[0] * x[3] + 1.0, x[0] * sum}};
  }
  void constraints(const VectorX& x, VectorX& c) override {
    c = VectorX{{x.prod(), x.squaredNorm()}};
  }
  void jacobian(const VectorX& x, double* values) override {
    for (int j = 0; j < 4; ++j) values[j] = x.prod() / x[j];
    for (int j = 0; j < 4; ++j) values[4 + j] = 2.0 * x[j];
  }
  void hessian(const VectorX& x, double factor, const VectorX& y, double* values) override {
    MatrixX h = MatrixX::Zero(4, 4);
    h(0, 0) = factor * 2.0 * x[3];
    h(1, 0) = h(2, 0) = factor * x[3];
    h(3, 0) = factor * (x.head(3).sum() + x[0]);
    h(3, 1) = h(3, 2) = factor * x[0];
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) h(i, j) += y[0] * x.prod() / (x[i] * x[j]);
      h(i, i) += 2.0 * y[1];
    }
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j <= i; ++j) *values++ = h(i, j);
    }
  }
};

const VectorX kSolution{{1.0, 4.7429994, 3.8211503, 1.3794082}};

TEST(Program, IsSolvedFromFar) {
  Problem71 program;
  const ProgramResult result = solve(program, {VectorX{{1.0, 5.0, 5.0, 1.0}}, {}, {}, {}});
  EXPECT_EQ(result.status, Status::solved);
  EXPECT_LT((result.point.x - kSolution).norm(), 1e-5);
  EXPECT_NEAR(result.objective, 17.0140173, 1e-5);
}

TEST(Program, IsSolvedFromNear) {
  Problem71 program;
  // Multipliers from the optimality conditions: rows -0.5522937, 0.1614686, bound 1.0878712.
  ProgramPoint start{kSolution + VectorX{{0.0, -0.1, 0.1, 0.05}}, VectorX{{-0.5, 0.2}},
                     VectorX{{1.0, 0.0, 0.0, 0.0}}, VectorX::Zero(4)};
  const auto near = solve_nearby(program, start, {.tolerance = 1e-9});
  ASSERT_TRUE(near.has_value());
  EXPECT_LT((near->point.x - kSolution).norm(), 1e-6);
  EXPECT_NEAR(near->objective, 17.0140173, 1e-6);
  EXPECT_NEAR(near->point.constraint_multipliers[0], -0.5522937, 1e-5);
  EXPECT_NEAR(near->point.constraint_multipliers[1], 0.1614686, 1e-5);
  EXPECT_NEAR(near->point.lower_multipliers[0], 1.0878712, 1e-5);
  EXPECT_LT(near->violation, 1e-7);
  EXPECT_LE(near->iterations, 12);
}

TEST(Program, FromNearAndFarAgreeWhereABoundMoves) {
  Problem71 before, after(27.0);
  const ProgramResult first = solve(before, {VectorX{{1.0, 5.0, 5.0, 1.0}}, {}, {}, {}});
  const ProgramResult far =
      solve(after, {VectorX{{1.0, 5.0, 5.0, 1.0}}, {}, {}, {}}, {.tolerance = 1e-9});
  const auto near = solve_nearby(after, first.point, {.tolerance = 1e-9});
  ASSERT_TRUE(near.has_value());
  EXPECT_LT((near->point.x - far.point.x).norm(), 1e-6);
  EXPECT_LT((near->point.constraint_multipliers - far.point.constraint_multipliers).norm(), 1e-5);
}

TEST(Program, ThatHasNoSolutionIsNotSolvedFromNear) {
  // The product of four numbers with a sum of squares of 40 is at most 100.
  Problem71 before, after(101.0);
  const ProgramResult first = solve(before, {VectorX{{1.0, 5.0, 5.0, 1.0}}, {}, {}, {}});
  EXPECT_FALSE(solve_nearby(after, first.point, {}).has_value());
  EXPECT_EQ(solve(after, first.point).status, Status::infeasible);
}

}  // namespace
}  // namespace sinew::plan
