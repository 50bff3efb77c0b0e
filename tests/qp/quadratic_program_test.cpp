#include "sinew/qp/quadratic_program.hpp"

#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"

#include "random_problem.hpp"

namespace sinew::qp {
namespace {

QuadraticProgram identity_problem(int n, int m) {
  QuadraticProgram problem = QuadraticProgram::sized(n, m);
  problem.hessian.setIdentity();
  return problem;
}

template <typename Call>
ErrorKind kind_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_FALSE(error.message().empty());
    EXPECT_FALSE(error.remedy().empty());
    return error.kind();
  }
  return ErrorKind::internal;
}

std::string kind_of_case(const ::testing::TestParamInfo<ProblemKind>& each) {
  return problem_kind_name(each.param);
}

class RandomProblems : public ::testing::TestWithParam<ProblemKind> {};

TEST_P(RandomProblems, MeetKktConditions) {
  Random random(2024 + static_cast<std::uint64_t>(GetParam()));
  const bool feasible = GetParam() != ProblemKind::infeasible;
  double worst = 0.0;
  for (int trial = 0; trial < 2000; ++trial) {
    const int n = random.integer(1, 50);
    const int m = random.integer(4, 100);
    const QuadraticProgram problem = random_problem(GetParam(), n, m, random);
    QpSolver solver(n, m);
    const QpResult& result = solver.solve(problem);
    const QpStatus expected = feasible ? QpStatus::optimal : QpStatus::infeasible;
    ASSERT_EQ(qp_status_name(result.status), qp_status_name(expected))
        << "trial " << trial << " n " << n << " m " << m << " iterations " << result.iterations;
    if (!feasible) continue;
    const double residual = kkt_residual(problem, result);
    worst = std::max(worst, residual);
    ASSERT_LE(residual, 1e-9) << "trial " << trial << " n " << n << " m " << m;
  }
  RecordProperty("worst_residual", std::to_string(worst));
  if (feasible) std::printf("worst KKT residual %.2e\n", worst);
}

INSTANTIATE_TEST_SUITE_P(Kinds, RandomProblems,
                         ::testing::Values(ProblemKind::well_scaled, ProblemKind::badly_scaled,
                                           ProblemKind::degenerate, ProblemKind::equality_heavy,
                                           ProblemKind::infeasible, ProblemKind::semidefinite),
                         kind_of_case);

// Sequences as a controller solves them: the target moves slightly, limits change with the state,
// and occasionally they conflict. Warm and cold starts must agree at each step.
class Sequences : public ::testing::TestWithParam<ProblemKind> {};

TEST_P(Sequences, WarmAndColdStartsAgree) {
  Random random(77);
  long warm_iterations = 0;
  long cold_iterations = 0;
  for (int run = 0; run < 60; ++run) {
    const int n = random.integer(2, 24);
    const int m = random.integer(4, 40);
    QuadraticProgram problem = random_problem(GetParam(), n, m, random);
    const VectorX start = problem.gradient;
    const VectorX drift = problem.gradient.cwiseAbs().cwiseProduct(random.vector(n));
    QpSolver warm(n, m);
    QpSolver cold(n, m, {.warm_start = false});
    for (int step = 0; step < 40; ++step) {
      problem.gradient = start + std::sin(0.1 * step) * drift;
      if (step % 10 == 5) problem.lower[step % n] = -kInfinity;
      const QpResult& a = warm.solve(problem);
      const QpResult& b = cold.solve(problem);
      ASSERT_EQ(qp_status_name(a.status), qp_status_name(QpStatus::optimal));
      ASSERT_EQ(qp_status_name(b.status), qp_status_name(QpStatus::optimal));
      ASSERT_LE(kkt_residual(problem, a), 1e-9);
      const VectorX scale = problem.hessian.diagonal().cwiseSqrt();
      const double size = b.x.cwiseProduct(scale).norm() + 1e-12;
      const double allowed = GetParam() == ProblemKind::badly_scaled ? 1e-6 : 1e-9;
      EXPECT_LE((a.x - b.x).cwiseProduct(scale).norm(), allowed * size);
      warm_iterations += a.iterations;
      cold_iterations += b.iterations;
    }
  }
  EXPECT_LT(4 * warm_iterations, cold_iterations);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Sequences,
                         ::testing::Values(ProblemKind::well_scaled, ProblemKind::badly_scaled,
                                           ProblemKind::degenerate, ProblemKind::equality_heavy),
                         kind_of_case);

TEST(QpSolver, SurvivesUnrelatedProblemsBetweenWarmStarts) {
  Random random(5);
  QpSolver solver(12, 20);
  for (int trial = 0; trial < 1500; ++trial) {
    const auto kind = static_cast<ProblemKind>(random.integer(0, 5));
    const QuadraticProgram problem = random_problem(kind, 12, 20, random);
    const QpResult& result = solver.solve(problem);
    const bool feasible = kind != ProblemKind::infeasible;
    ASSERT_EQ(qp_status_name(result.status),
              qp_status_name(feasible ? QpStatus::optimal : QpStatus::infeasible))
        << problem_kind_name(kind) << " trial " << trial;
    if (feasible) {
      ASSERT_LE(kkt_residual(problem, result), 1e-9) << "trial " << trial;
    }
  }
}

TEST(QpSolver, SolvesByHand) {
  // min (x - 3)^2/2 + (y - 1)^2/2, x <= 2, x + y = 2: x = 2, y = 0.
  QuadraticProgram problem = identity_problem(2, 1);
  problem.gradient << -3.0, -1.0;
  problem.upper[0] = 2.0;
  problem.rows << 1.0, 1.0;
  problem.row_lower[0] = problem.row_upper[0] = 2.0;
  QpSolver solver(2, 1);
  const QpResult& result = solver.solve(problem);
  ASSERT_EQ(result.status, QpStatus::optimal);
  EXPECT_DOUBLE_EQ(result.x[0], 2.0);
  EXPECT_NEAR(result.x[1], 0.0, 1e-15);
  // G x + g = (-1, -1) = y + C^T z: z = -1, y = (0, 0).
  EXPECT_NEAR(result.row_multiplier[0], -1.0, 1e-15);
  EXPECT_NEAR(result.bound_multiplier[0], 0.0, 1e-15);
}

TEST(QpSolver, ReadsOnlyTheLowerTriangle) {
  Random random(3);
  QuadraticProgram problem = random_problem(ProblemKind::well_scaled, 9, 8, random);
  const VectorX x = QpSolver(9, 8).solve(problem).x;
  problem.hessian.triangularView<Eigen::StrictlyUpper>().setConstant(
      std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(QpSolver(9, 8).solve(problem).x, x);
}

TEST(QpSolver, KeepsBoundsExactly) {
  Random random(11);
  for (int trial = 0; trial < 300; ++trial) {
    const QuadraticProgram problem = random_problem(ProblemKind::badly_scaled, 8, 16, random);
    QpSolver solver(8, 16);
    const QpResult& result = solver.solve(problem);
    ASSERT_EQ(result.status, QpStatus::optimal);
    EXPECT_TRUE((result.x.array() >= problem.lower.array()).all());
    EXPECT_TRUE((result.x.array() <= problem.upper.array()).all());
  }
}

TEST(QpSolver, MeetsManyCopiesOfOneLimit) {
  QuadraticProgram problem = identity_problem(3, 60);
  problem.gradient << 1.0, 1.0, 1.0;
  for (int i = 0; i < 60; ++i) {
    problem.rows.row(i).setConstant(i % 2 == 0 ? 1.0 : -0.1);
    problem.row_lower[i] = i % 2 == 0 ? 3.0 : -kInfinity;
    problem.row_upper[i] = i % 2 == 0 ? kInfinity : -0.3;
  }
  problem.lower.setConstant(1.0);
  QpSolver solver(3, 60);
  const QpResult& result = solver.solve(problem);
  ASSERT_EQ(result.status, QpStatus::optimal);
  EXPECT_LE(result.iterations, 10);
  EXPECT_LE((result.x - VectorX::Ones(3)).norm(), 1e-14);
}

TEST(QpSolver, AcceptsRedundantAndRefusesContradictingEqualities) {
  QuadraticProgram problem = identity_problem(3, 3);
  problem.rows << 1.0, 2.0, 3.0, 3.0, 2.0, 1.0, 4.0, 4.0, 4.0;
  problem.row_lower << 0.1, 0.2, 0.1 + 0.2;
  problem.row_upper = problem.row_lower;
  QpSolver solver(3, 3);
  EXPECT_EQ(solver.solve(problem).status, QpStatus::optimal);
  EXPECT_LE(kkt_residual(problem, solver.solve(problem)), 1e-12);
  problem.row_lower[2] = problem.row_upper[2] = 0.3 + 1e-7;
  EXPECT_EQ(solver.solve(problem).status, QpStatus::infeasible);
}

TEST(QpSolver, HandlesBoxesOfNoWidthAndRowsOfZeros) {
  QuadraticProgram problem = identity_problem(2, 2);
  problem.gradient << -1.0, 5.0;
  problem.lower << 0.25, -0.5;
  problem.upper << 0.25, -0.5;
  problem.rows.row(0) << 0.0, 0.0;
  problem.rows.row(1) << 1.0, 1.0;
  problem.row_lower << -1.0, -0.25;
  problem.row_upper << 0.0, -0.25;
  QpSolver solver(2, 2);
  ASSERT_EQ(solver.solve(problem).status, QpStatus::optimal);
  EXPECT_LE(kkt_residual(problem, solver.solve(problem)), 1e-14);
  problem.row_lower[0] = -2.0;
  problem.row_upper[0] = -1.0;
  EXPECT_EQ(solver.solve(problem).status, QpStatus::infeasible);
}

TEST(QpSolver, TellsBoundsThatNoRowCanMeetByAHair) {
  QuadraticProgram problem = identity_problem(4, 1);
  problem.rows.setOnes();
  problem.upper.setOnes();
  problem.row_lower[0] = 4.0;
  QpSolver solver(4, 1);
  EXPECT_EQ(solver.solve(problem).status, QpStatus::optimal);
  problem.row_lower[0] = 4.0 + 1e-9;
  EXPECT_EQ(solver.solve(problem).status, QpStatus::infeasible);
  problem.row_lower[0] = 4.0 - 1e-9;
  EXPECT_EQ(solver.solve(problem).status, QpStatus::optimal);
}

TEST(QpSolver, WorksWithoutRowsOrVariables) {
  QuadraticProgram problem = identity_problem(3, 0);
  problem.gradient << 1.0, 2.0, 3.0;
  EXPECT_EQ(QpSolver(3, 0).solve(problem).x, -problem.gradient);
  EXPECT_EQ(kkt_residual(problem, QpSolver(3, 0).solve(problem)), 0.0);
  EXPECT_EQ(QpSolver().solve(QuadraticProgram::sized(0, 0)).status, QpStatus::optimal);
}

TEST(QpSolver, NamesProblemsItCannotSolve) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  QuadraticProgram problem = identity_problem(2, 1);
  QpSolver solver(2, 1);
  problem.hessian << 1.0, 0.0, 0.0, -1.0;
  EXPECT_EQ(solver.solve(problem).status, QpStatus::not_convex);
  problem.hessian << 1.0, 1.0, 1.0, 0.0;
  EXPECT_EQ(solver.solve(problem).status, QpStatus::not_convex);
  problem.hessian << 1.0, 0.0, nan, 1.0;
  EXPECT_EQ(solver.solve(problem).status, QpStatus::not_finite);
  problem = identity_problem(2, 1);
  for (double* number : {&problem.gradient[1], &problem.rows(0, 0), &problem.lower[0],
                         &problem.row_upper[0], &problem.hessian(1, 1)}) {
    const double good = *number;
    *number = nan;
    EXPECT_EQ(solver.solve(problem).status, QpStatus::not_finite);
    *number = good;
  }
  problem.lower[0] = kInfinity;
  EXPECT_EQ(solver.solve(problem).status, QpStatus::not_finite);
  problem.lower[0] = -kInfinity;
  EXPECT_EQ(solver.solve(problem).status, QpStatus::optimal);
}

TEST(QpSolver, StopsAtItsIterationLimit) {
  Random random(9);
  QuadraticProgram problem = random_problem(ProblemKind::well_scaled, 30, 60, random);
  problem.gradient *= 10.0;
  const QpResult result = QpSolver(30, 60, {.max_iterations = 2}).solve(problem);
  EXPECT_EQ(result.status, QpStatus::iteration_limit);
  EXPECT_TRUE(result.x.allFinite());
}

TEST(QpSolver, RefusesWrongShapesAndContradictoryLimits) {
  QpSolver solver(2, 1);
  EXPECT_EQ(kind_of([&] { solver.solve(identity_problem(3, 1)); }), ErrorKind::wrong_shape);
  EXPECT_EQ(kind_of([&] { solver.solve(identity_problem(2, 2)); }), ErrorKind::wrong_shape);
  QuadraticProgram problem = identity_problem(2, 1);
  problem.row_lower[0] = 1.0;
  problem.row_upper[0] = 0.0;
  EXPECT_EQ(kind_of([&] { solver.solve(problem); }), ErrorKind::contradictory_limits);
}

TEST(QpSolver, NamesEachStatusOnce) {
  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(QpStatus::not_finite); ++i) {
    names.insert(qp_status_name(static_cast<QpStatus>(i)));
  }
  EXPECT_EQ(names.size(), 6u);
}

// Two cables on one path share the effort; if one is at its limit, the other takes the rest.
TEST(QpSolver, TwinsShareEvenlyWithinTheirLimits) {
  QuadraticProgram problem = QuadraticProgram::sized(3, 0);
  problem.hessian << 1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 2.0;
  problem.gradient << -3.0, -3.0, -2.0;
  problem.lower.setZero();
  QpSolver solver(3, 0);
  EXPECT_LE((solver.solve(problem).x - Vector3(1.5, 1.5, 1.0)).norm(), 1e-14);
  EXPECT_EQ(solver.solve(problem).status, QpStatus::optimal);
  problem.upper[0] = 1.0;
  EXPECT_LE((solver.solve(problem).x - Vector3(1.0, 2.0, 1.0)).norm(), 1e-14);
  problem.upper[1] = 1.5;  // too little: the multipliers are the missing pull
  const QpResult& result = solver.solve(problem);
  EXPECT_LE((result.x - Vector3(1.0, 1.5, 1.0)).norm(), 1e-14);
  EXPECT_LE((result.bound_multiplier - Vector3(-0.5, -0.5, 0.0)).norm(), 1e-8);
  EXPECT_LE(kkt_residual(problem, result), 1e-12);
}

// A linear program (no quadratic part) whose optimal edge leaves a choice.
TEST(QpSolver, SolvesLinearProgramsToTheLeastPoint) {
  QuadraticProgram problem = QuadraticProgram::sized(3, 1);
  problem.gradient << -1.0, -1.0, 0.0;
  problem.rows << 1.0, 1.0, 1.0;
  problem.row_upper[0] = 4.0;
  problem.lower << 0.0, 0.0, -5.0;
  QpSolver solver(3, 1);
  const QpResult& result = solver.solve(problem);
  ASSERT_EQ(qp_status_name(result.status), "optimal");
  EXPECT_LE((result.x - Vector3(4.5, 4.5, -5.0)).norm(), 1e-10);
  EXPECT_LE(kkt_residual(problem, result), 1e-10);
}

TEST(QpSolver, NamesTheRayOfAnUnboundedProblem) {
  QuadraticProgram problem = QuadraticProgram::sized(4, 1);
  problem.hessian(0, 0) = 1.0;
  problem.hessian.block(1, 1, 2, 2) << 2.0, 2.0, 2.0, 2.0;
  problem.gradient << -7.0, 1.0, -1.0, 0.0;  // drives the twins apart
  QpSolver solver(4, 1);
  const QpResult& result = solver.solve(problem);
  ASSERT_EQ(qp_status_name(result.status), "unbounded");
  EXPECT_LE((result.ray - Eigen::Vector4d(0.0, -1.0, 1.0, 0.0)).norm(), 1e-6);
  problem.lower[1] = -20.0;
  EXPECT_EQ(qp_status_name(solver.solve(problem).status), "optimal");
  EXPECT_LE((solver.solve(problem).x - Eigen::Vector4d(7.0, -20.0, 20.5, 0.0)).norm(), 1e-8);
}

TEST(KktResidual, SeesEachKindOfError) {
  QuadraticProgram problem = identity_problem(2, 1);
  problem.gradient << -3.0, -1.0;
  problem.upper[0] = 2.0;
  problem.rows << 0.0, 1.0;
  problem.row_upper[0] = 5.0;
  const QpResult good = QpSolver(2, 1).solve(problem);
  EXPECT_LE(kkt_residual(problem, good), 1e-15);
  QpResult bad = good;
  bad.x[1] += 0.1;
  EXPECT_GT(kkt_residual(problem, bad), 1e-2);
  bad = good;
  bad.x[0] = 3.0;
  bad.bound_multiplier[0] = 0.0;
  EXPECT_GT(kkt_residual(problem, bad), 1e-2);  // infeasible
  bad = good;
  bad.x[0] = 4.0;
  bad.bound_multiplier[0] = 1.0;
  EXPECT_GT(kkt_residual(problem, bad), 1e-2);  // wrong sign
  bad = good;
  bad.row_multiplier[0] = -1.0;
  bad.x[1] = 0.0;
  EXPECT_GT(kkt_residual(problem, bad), 1e-2);  // multiplier with slack
}

}  // namespace
}  // namespace sinew::qp
