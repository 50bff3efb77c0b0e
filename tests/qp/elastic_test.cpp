#include "sinew/qp/elastic.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"

#include "random_problem.hpp"

namespace sinew::qp {
namespace {

/// min |x|^2 / 2 over 0 <= x <= 1, x_0 + x_1 >= 3, x_0 <= 0.5. The bounds leave at most 2 for row
/// 0.
QuadraticProgram two_rows() {
  QuadraticProgram problem = QuadraticProgram::sized(2, 2);
  problem.hessian.setIdentity();
  problem.lower.setZero();
  problem.upper.setOnes();
  problem.rows << 1.0, 1.0, 1.0, 0.0;
  problem.row_lower << 3.0, -kInfinity;
  problem.row_upper << kInfinity, 0.5;
  return problem;
}

VectorX violations(const QuadraticProgram& problem, const VectorX& x) {
  const VectorX value = problem.rows * x;
  return (problem.row_lower - value).cwiseMax(value - problem.row_upper).cwiseMax(0.0);
}

TEST(Elastic, IsThePlainProblemWhenRowsAgree) {
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const QuadraticProgram problem = random_problem(ProblemKind::degenerate, 10, 14, random);
    const ElasticResult elastic = solve_elastic(problem);
    ASSERT_EQ(elastic.status, ElasticStatus::optimal);
    EXPECT_EQ(elastic.relaxed, 0);
    EXPECT_EQ(elastic.programs, 1);
    EXPECT_EQ(elastic.violation.norm(), 0.0);
    EXPECT_EQ(elastic.qp.x, QpSolver(10, 14).solve(problem).x);
  }
}

TEST(Elastic, SharesTheWorstViolation) {
  // With x_1 = 1, equal violations 3 - x_0 - x_1 = x_0 - 0.5 would need x_0 = 1.25 > 1. Hence row 0
  // alone determines the worst violation, 1, which requires x = (1, 1) and leaves 0.5 for row 1.
  const ElasticResult result = solve_elastic(two_rows());
  ASSERT_EQ(result.status, ElasticStatus::relaxed);
  EXPECT_NEAR(result.qp.x[0], 1.0, 1e-12);
  EXPECT_NEAR(result.qp.x[1], 1.0, 1e-12);
  EXPECT_NEAR(result.violation[0], -1.0, 1e-12);
  EXPECT_NEAR(result.violation[1], 0.5, 1e-12);
  EXPECT_EQ(result.relaxed, 2);
}

TEST(Elastic, WeighsRows) {
  // Row 1 in units ten times finer: 3 - x_0 - 1 = 10 (x_0 - 0.5) at x_0 = 7/11.
  ElasticSolver solver(2, 2);
  const ElasticResult& result = solver.solve(two_rows(), (VectorX(2) << 1.0, 10.0).finished());
  ASSERT_EQ(result.status, ElasticStatus::relaxed);
  EXPECT_NEAR(result.qp.x[0], 7.0 / 11.0, 1e-10);
  EXPECT_NEAR(result.qp.x[1], 1.0, 1e-12);
}

TEST(Elastic, MinimisesTheObjectiveAmongEquallyViolatingPoints) {
  // x_0 >= 1 conflicts with x_0 <= 0 (two rows). The sum of the violations is 1 for every x_0 in
  // [0, 1], so the objective (x_0 - 0.3)^2 / 2 + (x_1 + 2)^2 / 2 decides. The worst violation is
  // smallest at x_0 = 0.5 only.
  QuadraticProgram problem = QuadraticProgram::sized(2, 2);
  problem.hessian.setIdentity();
  problem.gradient << -0.3, 2.0;
  problem.rows << 1.0, 0.0, 1.0, 0.0;
  problem.row_lower << 1.0, -kInfinity;
  problem.row_upper << kInfinity, 0.0;
  const ElasticResult sum = solve_elastic(problem, {.measure = ElasticMeasure::sum});
  ASSERT_EQ(sum.status, ElasticStatus::relaxed);
  EXPECT_NEAR(sum.qp.x[0], 0.3, 1e-10);
  EXPECT_NEAR(sum.qp.x[1], -2.0, 1e-10);
  const ElasticResult worst = solve_elastic(problem);
  ASSERT_EQ(worst.status, ElasticStatus::relaxed);
  EXPECT_NEAR(worst.qp.x[0], 0.5, 1e-10);
  EXPECT_NEAR(worst.qp.x[1], -2.0, 1e-10);
}

TEST(Elastic, LoosensNoRowThatIsNotInTheWay) {
  // Rows 0 and 1 conflict by 2; row 2 requires x_1 >= 0.1, against the -5 of the objective, and can
  // be satisfied.
  QuadraticProgram problem = QuadraticProgram::sized(2, 3);
  problem.hessian.setIdentity();
  problem.gradient << 0.0, 5.0;
  problem.rows << 1.0, 0.0, 1.0, 0.0, 0.0, 1.0;
  problem.row_lower << 2.0, -kInfinity, 0.1;
  problem.row_upper << kInfinity, 0.0, kInfinity;
  for (const ElasticMeasure measure : {ElasticMeasure::worst, ElasticMeasure::sum}) {
    const ElasticResult result = solve_elastic(problem, {.measure = measure});
    ASSERT_EQ(result.status, ElasticStatus::relaxed);
    EXPECT_NEAR(result.qp.x[1], 0.1, 1e-10);
    EXPECT_EQ(result.violation[2], 0.0);
  }
}

TEST(Elastic, ReportsWhichRowsAreRelaxed) {
  // Two groups with conflicts of different size: leximin resolves each at its own level.
  QuadraticProgram problem = QuadraticProgram::sized(2, 4);
  problem.hessian.setIdentity();
  problem.rows << 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0;
  problem.row_lower << 4.0, -kInfinity, 1.0, -kInfinity;
  problem.row_upper << kInfinity, 0.0, kInfinity, 0.0;
  const ElasticResult result = solve_elastic(problem);
  ASSERT_EQ(result.status, ElasticStatus::relaxed);
  EXPECT_LE((result.qp.x - Eigen::Vector2d(2.0, 0.5)).norm(), 1e-9);
  EXPECT_LE((result.violation - Eigen::Vector4d(-2.0, 2.0, -0.5, 0.5)).norm(), 1e-9);
  EXPECT_EQ(result.relaxed, 4);
}

TEST(Elastic, PassesOnOtherFailures) {
  QuadraticProgram problem = two_rows();
  problem.hessian(1, 1) = -1.0;
  EXPECT_EQ(solve_elastic(problem).status, ElasticStatus::not_convex);
  problem = two_rows();
  problem.gradient[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solve_elastic(problem).status, ElasticStatus::not_finite);
  EXPECT_EQ(elastic_status_name(ElasticStatus::relaxed), "relaxed");
  ElasticSolver solver(2, 2);
  EXPECT_THROW(solver.solve(two_rows(), VectorX::Ones(3)), Error);
  EXPECT_THROW(solver.solve(two_rows(), VectorX::Zero(2)), Error);
  EXPECT_EQ(solver.solve(two_rows()).status, ElasticStatus::relaxed);
}

class ElasticRandom : public ::testing::TestWithParam<ElasticMeasure> {};

// By convexity, a local minimum of the violation is global; against_cvxopt.py compares the minimum
// itself with that of a linear program.
TEST_P(ElasticRandom, BeatsEveryNearbyPoint) {
  Random random(42);
  ElasticSolver solver(8, 16, {.measure = GetParam()});
  for (int trial = 0; trial < 400; ++trial) {
    const QuadraticProgram problem = random_problem(ProblemKind::infeasible, 8, 16, random);
    const ElasticResult& result = solver.solve(problem);
    ASSERT_EQ(elastic_status_name(result.status), "relaxed") << "trial " << trial;
    const VectorX& x = result.qp.x;
    ASSERT_TRUE((x.array() >= problem.lower.array()).all());
    ASSERT_TRUE((x.array() <= problem.upper.array()).all());
    const auto measure = [&](const VectorX& at) {
      const VectorX v = violations(problem, at);
      return GetParam() == ElasticMeasure::worst ? v.maxCoeff() : v.sum();
    };
    const double best = measure(x);
    EXPECT_LE(result.programs, 80);
    for (int probe = 0; probe < 300; ++probe) {
      const double radius = std::pow(10.0, random.uniform(-6.0, 0.0));
      const VectorX moved =
          (x + radius * random.vector(8)).cwiseMax(problem.lower).cwiseMin(problem.upper);
      ASSERT_GE(measure(moved), best * (1.0 - 1e-7) - 1e-9 * radius) << "trial " << trial;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Measures, ElasticRandom,
                         ::testing::Values(ElasticMeasure::worst, ElasticMeasure::sum));

}  // namespace
}  // namespace sinew::qp
