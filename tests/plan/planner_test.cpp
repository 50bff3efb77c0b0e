// Plans: replays, warm starts, limits, obstacles, and infeasible tasks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/arm_simulation.hpp"
#include "sinew/plan/replay.hpp"

#include "reintegration.hpp"
#include "tasks.hpp"

namespace sinew::plan {
namespace {

using testing::grab;
using testing::kGoals;
using testing::make;
using testing::reintegrated;
using testing::TipEnd;

std::shared_ptr<const pcc::Arm> fluidic() { return make(pcc::testing::fluidic()); }

ErrorKind kind_of(const PlanTask& task) {
  try {
    completed(*fluidic(), task);
  } catch (const Error& error) {
    return error.kind();
  }
  return ErrorKind::internal;
}

/// The final errors of a plan agree with an independent integration of its torques and are within
/// the tolerances, with and without limits on the rates of torques.
TEST(Planner, ClaimsAreThoseOfAnIndependentIntegration) {
  const auto arm = fluidic();
  std::vector<Vector3> goals(std::begin(kGoals), std::end(kGoals));
  goals.emplace_back(0.35, 0.0, -0.28);
  for (const double rate : {kNoBound, 2.0}) {
    for (const Vector3& goal : goals) {
      // With rates of torque limited to 2 N m/s, the arm cannot swing as high in this time.
      if (rate < kNoBound && goal == goals.back()) continue;
      PlanTask task = grab(goal);
      task.limits.torque_rate = VectorX::Constant(4, rate);
      const Plan plan = Planner(arm, task).plan(1);
      ASSERT_EQ(plan.status, PlanStatus::solved) << goal.transpose();
      EXPECT_LE(plan.tip_error, task.goal.tolerance);
      EXPECT_LE(plan.tip_speed, task.goal.speed_tolerance);
      const TipEnd end = reintegrated(arm, task, plan);
      EXPECT_NEAR((end.position - goal).norm(), plan.tip_error, 0.005 * task.goal.tolerance);
      EXPECT_NEAR(end.velocity.norm(), plan.tip_speed, 0.005 * task.goal.speed_tolerance);
    }
  }
}

/// The damping of backward Euler at 80 ms exists only in the plan.
TEST(Planner, SaysWhereTheMotionOfTheTorquesMisses) {
  const auto arm = fluidic();
  PlanTask task = grab(kGoals[2]);
  task.grid = {.method = CollocationMethod::backward_euler, .duration = 2.4, .intervals = 30};
  const Plan plan = Planner(arm, task, {.corrections = 0}).plan(1);
  EXPECT_EQ(plan.status, PlanStatus::not_met_on_replay);
  EXPECT_EQ(status_name(plan.status), "not-met-on-replay");
  EXPECT_FALSE(plan.found());
  EXPECT_LE(plan.planned_tip_error, task.goal.tolerance);
  EXPECT_LE(plan.planned_tip_speed, task.goal.speed_tolerance);
  EXPECT_GT(plan.tip_error, 10.0 * task.goal.tolerance);
  const TipEnd end = reintegrated(arm, task, plan);
  EXPECT_NEAR((end.position - task.goal.position).norm(), plan.tip_error, 1e-5);
}

/// Too few knots lead to a corrected aim or a finer mesh.
TEST(Planner, CorrectsWhatCoarseKnotsMiss) {
  const auto arm = fluidic();
  PlanTask task = grab(kGoals[0]);
  task.grid.intervals = 8;
  const Plan before = Planner(arm, task, {.corrections = 0}).plan(1);
  ASSERT_EQ(before.status, PlanStatus::not_met_on_replay);
  const Plan plan = Planner(arm, task).plan(1);
  ASSERT_TRUE(plan.found());
  EXPECT_GT(plan.corrections, 0);
  EXPECT_NEAR(plan.fractions().sum(), 1.0, 1e-12);
  // Replanning keeps the knots.
  task.goal.position.x() += 0.005;
  const Plan next = Planner(arm, task).replan(plan);
  ASSERT_TRUE(next.found());
  EXPECT_GE(next.knots.times.size(), plan.knots.times.size());
}

TEST(Planner, PlansThatAreCarriedOutReachTheirGoals) {
  const auto arm = fluidic();
  for (const Vector3& goal : kGoals) {
    PlanTask task = grab(goal);
    task.limits.torque_rate = VectorX::Constant(4, 2.0);
    const Plan plan = Planner(arm, task).plan(1);
    ASSERT_EQ(plan.status, PlanStatus::solved);
    const Replay run = replay(arm, task, plan);
    EXPECT_NEAR(run.tip_error, plan.tip_error, 1e-3 * task.goal.tolerance);
    EXPECT_NEAR(run.tip_speed, plan.tip_speed, 1e-3 * task.goal.speed_tolerance);
    EXPECT_TRUE(
        (plan.knots.torque.cwiseAbs().rowwise() - pcc::published_torque_limits().transpose())
            .maxCoeff() < 1e-8);
    const MatrixX change = plan.knots.torque.bottomRows(50) - plan.knots.torque.topRows(50);
    EXPECT_LT(change.cwiseAbs().maxCoeff() / (plan.duration() / 50), 2.0 + 1e-6);
  }
}

/// The knots of backward Euler equal the states of a simulation with backward Euler.
TEST(Planner, EulersPlanIsTheSimulationsMotion) {
  const auto arm = fluidic();
  PlanTask task = grab(kGoals[2]);
  task.grid = {.method = CollocationMethod::backward_euler, .duration = 2.4, .intervals = 30};
  const Plan plan = Planner(arm, task, {.corrections = 0}).plan(1);
  ASSERT_EQ(plan.status, PlanStatus::not_met_on_replay);
  pcc::ArmSimulation simulation(
      arm, {.time_step = 0.08, .integrator = mechanics::Integrator::backward_euler});
  for (int k = 1; k <= 30; ++k) {
    simulation.step(plan.knots.torque.row(k).transpose());
    EXPECT_LT((simulation.position() - plan.knots.position.row(k).transpose()).norm(), 1e-5) << k;
  }
}

/// The difference between the motion of the program and that of its torque decreases fast with the
/// distance of knots, also without limits on the rates of torques.
TEST(Planner, RadauConverges) {
  const auto arm = fluidic();
  std::vector<double> gaps;
  for (const int intervals : {20, 40}) {
    PlanTask task = grab(kGoals[1]);
    task.grid.intervals = intervals;
    const Plan plan = Planner(arm, task, {.corrections = 0}).plan(1);
    const Replay run = replay(arm, task, plan);
    gaps.push_back((run.position.bottomRows(1) - plan.knots.position.bottomRows(1)).norm());
  }
  EXPECT_GT(gaps[0] / gaps[1], 8.0);
}

TEST(Planner, StartsDoNotChangeTheOptimum) {
  const auto arm = fluidic();
  Planner planner(arm, grab(kGoals[2]));
  const double first = planner.plan(1).objective;
  for (const std::uint64_t seed : {2, 3}) {
    const Plan plan = planner.plan(seed);
    ASSERT_TRUE(plan.found());
    EXPECT_NEAR(plan.objective, first, 1e-5 * first);
  }
}

TEST(Planner, AWarmStartNeedsFewerIterations) {
  const auto arm = fluidic();
  const Plan before = Planner(arm, grab(kGoals[2])).plan(1);
  Planner moved(arm, grab(kGoals[2] + Vector3(0.01, 0.0, 0.005)));
  const Plan warm = moved.replan(before), cold = moved.plan(1);
  ASSERT_TRUE(warm.found());
  EXPECT_NEAR(warm.objective, cold.objective, 1e-4 * cold.objective);
  EXPECT_LT(warm.iterations, cold.iterations);
  PlanTask other = grab(kGoals[2]);
  other.limits.torque_rate = VectorX::Constant(4, 2.0);
  EXPECT_THROW(Planner(arm, other).replan(before), Error);
}

/// An initial state out of equilibrium excites fast modes, which decay in the first interval of the
/// plan.
TEST(Planner, PlansFromDisturbedStarts) {
  const auto arm = fluidic();
  std::mt19937 random(3);
  for (int trial = 0; trial < 3; ++trial) {
    PlanTask task = grab(kGoals[2]);
    task.limits.torque_rate = VectorX::Constant(4, 2.0);
    task.start.position = pcc::testing::random_vector(random, 4, 0.1);
    task.start.rate = pcc::testing::random_vector(random, 4, 0.5);
    const Plan plan = Planner(arm, task).plan(1);
    ASSERT_TRUE(plan.found()) << trial;
    const TipEnd end = reintegrated(arm, task, plan);
    EXPECT_LT((end.position - task.goal.position).norm(), 1.005 * task.goal.tolerance) << trial;
    EXPECT_LT(end.velocity.norm(), 1.005 * task.goal.speed_tolerance) << trial;
  }
}

TEST(Planner, AFreeDurationDoesNotCostMore) {
  const auto arm = fluidic();
  PlanTask task = grab(kGoals[2]);
  const Plan fixed = Planner(arm, task).plan(1);
  task.grid.min_duration = 1.0;
  task.grid.max_duration = 2.0;
  const Plan free = Planner(arm, task).plan(1);
  ASSERT_TRUE(free.found());
  // Each to its own correction.
  EXPECT_LE(free.objective, fixed.objective * (1.0 + 1e-2));
  EXPECT_GE(free.duration(), 1.0 - 1e-8);
  EXPECT_LE(free.duration(), 2.0 + 1e-8);
}

TEST(Planner, KeepsClearOfObstacles) {
  const auto arm = fluidic();
  PlanTask task = grab(kGoals[2]);
  const Plan before = Planner(arm, task).plan(1);
  // An obstacle in the path of the tip, at its largest distance from the goal.
  const Points tip = replay(arm, task, before).tip;
  Eigen::Index furthest = 0;
  (tip.rowwise() - task.goal.position.transpose()).rowwise().norm().maxCoeff(&furthest);
  const Vector3 swing = tip.row(furthest) - 0.02 * tip.row(furthest).normalized();
  task.obstacles = {{.point = swing, .radius = 0.03, .clearance = 0.01}};
  ASSERT_LT(replay(arm, task, before).clearance(), 0.0);
  const Plan plan = Planner(arm, task).plan(1);
  ASSERT_TRUE(plan.found());
  const Replay run = replay(arm, task, plan);
  // Also between knots, and between the points that the program checks.
  EXPECT_GT(run.clearance(), 0.01 - 1e-4);
  EXPECT_GE(plan.clearance, 0.01);
  EXPECT_LE(run.tip_error, 1.001 * task.goal.tolerance);
}

TEST(Planner, SaysWhereThereIsNoPlan) {
  PlanTask task = grab(kGoals[3]);
  task.grid.duration = 0.3;  // too short for a swing
  task.grid.intervals = 10;
  const Plan plan = Planner(fluidic(), task).plan(1);
  EXPECT_EQ(plan.status, PlanStatus::infeasible);
  EXPECT_FALSE(plan.found());
  EXPECT_EQ(status_name(plan.status), "infeasible");
}

TEST(Planner, StopsAtItsLimits) {
  Planner planner(fluidic(), grab(), {.solver = {.max_iterations = 3}});
  const Plan plan = planner.plan(1);
  EXPECT_EQ(plan.status, PlanStatus::iteration_limit);
  EXPECT_EQ(plan.iterations, 3);
}

TEST(Planner, RefusesTasksThatMakeNoSense) {
  EXPECT_EQ(kind_of(grab({0.5, 0.0, -0.4})), ErrorKind::out_of_range);  // beyond 0.56 m
  EXPECT_EQ(kind_of(grab({std::nan(""), 0.0, -0.4})), ErrorKind::not_finite);
  PlanTask task = grab();
  task.limits.torque_lower[1] = 0.2;
  EXPECT_EQ(kind_of(task), ErrorKind::contradictory_limits);
  task = grab();
  task.limits.angle_lower = VectorX::Constant(4, 0.1);  // the straight start is outside
  EXPECT_EQ(kind_of(task), ErrorKind::contradictory_limits);
  task = grab();
  task.limits.rate = VectorX::Zero(3);
  EXPECT_EQ(kind_of(task), ErrorKind::wrong_length);
  task = grab();
  task.goal.tolerance = 0.0;
  EXPECT_EQ(kind_of(task), ErrorKind::out_of_range);
  task = grab();
  task.grid.min_duration = 2.0;
  task.grid.max_duration = 1.0;
  EXPECT_EQ(kind_of(task), ErrorKind::contradictory_limits);
  task = grab();
  task.grid.fractions = VectorX::Constant(50, 0.01);
  EXPECT_EQ(kind_of(task), ErrorKind::out_of_range);
  task = grab();
  task.obstacles = {{.radius = -0.1}};
  EXPECT_EQ(kind_of(task), ErrorKind::out_of_range);
  try {
    completed(*fluidic(), grab({0.5, 0.0, -0.4}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("0.6403 m from the base"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("0.56 m long"));
  }
}

}  // namespace
}  // namespace sinew::plan
