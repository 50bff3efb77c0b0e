// The regulator: linearisation, Riccati equation, and effect of feedback.
#include "sinew/plan/tracking.hpp"

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/arm_simulation.hpp"

#include "tasks.hpp"

namespace sinew::plan {
namespace {

using testing::grab;
using testing::kGoals;
using testing::make;

TEST(Tracking, LinearisesTheImplicitStep) {
  const auto arm = make(pcc::testing::fluidic(pcc::MassCentre::distributed));
  const double h = 5e-3;
  pcc::ArmSimulation simulation(
      arm,
      {.time_step = h, .integrator = mechanics::Integrator::backward_euler, .tolerance = 1e-13});
  const VectorX q{{0.3, -0.5, 0.7, 0.2}}, v{{1.0, -2.0, 0.5, 3.0}}, torque{{0, 0.1, -0.1, 0.05}};
  const auto step = [&](const VectorX& from, const VectorX& by) {
    simulation.set_state(from.head(4), from.tail(4));
    simulation.step(by);
    VectorX to(8);
    to << simulation.position(), simulation.rate();
    return to;
  };
  VectorX x(8);
  x << q, v;
  const VectorX next = step(x, torque);
  const auto linear =
      linearise_step(simulation.equations(), next.head(4), next.tail(4), (next.tail(4) - v) / h, h);
  const double e = 1e-6;
  for (int i = 0; i < 8; ++i) {
    const VectorX difference =
        (step(x + e * VectorX::Unit(8, i), torque) - step(x - e * VectorX::Unit(8, i), torque)) /
        (2.0 * e);
    EXPECT_LT((linear.state.col(i) - difference).norm(), 1e-5 * (1.0 + difference.norm())) << i;
  }
  for (int i = 0; i < 4; ++i) {
    const VectorX difference =
        (step(x, torque + e * VectorX::Unit(4, i)) - step(x, torque - e * VectorX::Unit(4, i))) /
        (2.0 * e);
    EXPECT_LT((linear.input.col(i) - difference).norm(), 1e-5 * (1.0 + difference.norm())) << i;
  }
}

/// At rest, the recursion converges to a solution of the algebraic Riccati equation
/// P = Q + A'PA - A'PB (R + B'PB)^-1 B'PA, and x'Px is the cost of the regulated motion.
TEST(Tracking, SolvesRiccatisEquation) {
  const auto arm = make(pcc::testing::fluidic(pcc::MassCentre::distributed));
  pcc::ArmEquations equations(arm);
  const VectorX zero = VectorX::Zero(4);
  const auto step = linearise_step(equations, zero, zero, zero, 5e-3);
  const MatrixX q = MatrixX::Identity(8, 8), r = 10.0 * MatrixX::Identity(4, 4);
  RiccatiStep at{{}, MatrixX::Zero(8, 8)};
  for (int i = 0; i < 20000; ++i) at = riccati_step(step, q, r, at.cost);
  const MatrixX &a = step.state, &b = step.input, &p = at.cost;
  const MatrixX residual =
      q + a.transpose() * p * a -
      a.transpose() * p * b * (r + b.transpose() * p * b).inverse() * b.transpose() * p * a - p;
  EXPECT_LT(residual.norm(), 1e-8 * p.norm());
  VectorX x = VectorX::LinSpaced(8, -1.0, 1.0);
  const double expected = x.dot(p * x);
  double cost = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const VectorX u = -at.gain * x;
    cost += x.dot(q * x) + u.dot(r * u);
    x = a * x + b * u;
  }
  EXPECT_NEAR(cost, expected, 1e-8 * expected);
}

TEST(Tracking, FeedbackBringsDisturbedArmsNearer) {
  const auto arm = make(pcc::testing::fluidic());
  const PlanTask task = grab(kGoals[2]);
  const Plan plan = Planner(arm, task).plan(1);
  ASSERT_TRUE(plan.found());
  const Tracker tracker(arm, task, plan);
  // Without deviations, both follow the plan.
  EXPECT_LT(track(arm, tracker).tip_error, 0.004);
  EXPECT_LT(track(arm, tracker, {.feedback = false}).tip_error, 0.004);
  pcc::ArmSettings heavier = pcc::testing::fluidic();
  for (pcc::Segment& segment : heavier.segments) segment.mass *= 1.1;
  const VectorX offset{{0.05, -0.05, 0.05, 0.0}};
  for (const TrackingTrial& trial :
       {TrackingTrial{.position = offset}, TrackingTrial{.rate = 10.0 * offset}}) {
    TrackingTrial open = trial;
    open.feedback = false;
    EXPECT_LT(2.0 * track(arm, tracker, trial).tip_error, track(arm, tracker, open).tip_error);
  }
  EXPECT_LT(track(make(heavier), tracker).tip_error,
            track(make(heavier), tracker, {.feedback = false}).tip_error);
}

TEST(Tracking, KeepsTheLimits) {
  const auto arm = make(pcc::testing::fluidic());
  const PlanTask task = grab(kGoals[2]);
  const Plan plan = Planner(arm, task).plan(1);
  const Tracker tracker(arm, task, plan);
  const Replay run = track(arm, tracker, {.position = VectorX::Constant(4, 0.3)});
  EXPECT_LE((run.torque.cwiseAbs().rowwise() - task.limits.torque_upper.transpose()).maxCoeff(),
            1e-12);
  EXPECT_EQ(run.torque.col(0).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_THROW(Tracker(arm, task, plan, {.angle = 0.0}), Error);
}

}  // namespace
}  // namespace sinew::plan
