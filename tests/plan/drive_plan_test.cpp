// Plans of drive commands, simulated through the whole chain.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "sinew/pcc/arm_simulation.hpp"
#include "sinew/plan/drive_inversion.hpp"
#include "sinew/plan/replay.hpp"

#include "reintegration.hpp"
#include "support/error_kind.hpp"
#include "tasks.hpp"

namespace sinew::plan {
namespace {

using sinew::testing::kind_of;
using testing::grab;
using testing::kGoals;
using testing::make;
using testing::reintegrated;
using testing::TipEnd;

constexpr double kLead = 0.25;

/// A drive. @param frequency of the cylinders, rad/s.
DriveTrain drive(double frequency) {
  DriveTrain drive;
  drive.lead = kLead;
  for (int i = 0; i < 4; ++i) {
    DriveChannel channel{{0.0, 4e12, 0.077},
                         pcc::DriveCylinder::second_order(1.0, frequency, 0.8, 0.01)};
    channel.cylinder.lowest_input = -8e-5;
    channel.cylinder.highest_input = 8e-5;
    channel.cylinder.lowest_volume = -4e-5;
    channel.cylinder.highest_volume = 4e-5;
    drive.channels.push_back(channel);
  }
  return drive;
}

PlanTask driven(const Vector3& goal, double frequency) {
  PlanTask task = grab(goal);
  task.drive = drive(frequency);
  return task;
}

class DrivePlan : public ::testing::TestWithParam<double> {};

/// Planned commands reach the planned end through the whole chain. Torques that are planned first
/// and then inverted end with a higher tip speed, the slower the cylinders are.
TEST_P(DrivePlan, EndsAtTheGoalThroughTheChain) {
  const auto arm = make(pcc::testing::fluidic());
  for (const Vector3& goal : {kGoals[1], kGoals[2]}) {
    const PlanTask task = driven(goal, GetParam());
    const Plan found = Planner(arm, task).plan(1);
    ASSERT_TRUE(found.found());
    const Replay run = replay(arm, task, *found.knots.drive);
    EXPECT_NEAR(run.times[run.times.size() - 1], kLead + 1.6, 1e-12);
    EXPECT_LE(found.tip_error, task.goal.tolerance);
    EXPECT_LE(found.tip_speed, task.goal.speed_tolerance);
    EXPECT_NEAR(run.tip_error, found.tip_error, 0.005 * task.goal.tolerance);
    EXPECT_NEAR(run.tip_speed, found.tip_speed, 0.005 * task.goal.speed_tolerance);
    const TipEnd end = reintegrated(arm, task, found);
    EXPECT_NEAR((end.position - goal).norm(), found.tip_error, 0.005 * task.goal.tolerance);
    EXPECT_NEAR(end.velocity.norm(), found.tip_speed, 0.005 * task.goal.speed_tolerance);

    PlanTask torques = task;
    torques.drive.reset();
    torques.limits.torque_rate = VectorX::Constant(4, 2.0);
    const DriveInversion inverse =
        invert_drive(Planner(arm, torques).plan(1), task.drive->channels, kLead);
    const Replay after = replay(arm, task, {task.drive->channels, inverse.command, kLead});
    EXPECT_GT(after.tip_speed, run.tip_speed);
  }
}

INSTANTIATE_TEST_SUITE_P(Cylinders, DrivePlan, ::testing::Values(40.0, 20.0),
                         [](const auto& of) { return std::to_string(std::lround(of.param)); });

TEST(DrivePlan, KeepsItsLimits) {
  const auto arm = make(pcc::testing::fluidic());
  PlanTask task = driven(kGoals[2], 20.0);
  const double volume = 2.9e-5, command = 3.6e-5, rate = 5e-4;
  for (DriveChannel& channel : task.drive->channels) {
    channel.cylinder.highest_volume = volume;
    channel.cylinder.highest_input = command;
  }
  task.limits.command_rate = VectorX::Constant(4, rate);
  const Plan found = Planner(arm, task).plan(1);
  ASSERT_TRUE(found.found());
  const DriveRun& run = *found.knots.drive;
  const double rounding = 1e-6;
  EXPECT_LE(run.volume.maxCoeff(), volume * (1.0 + rounding));
  EXPECT_LE(run.command.maxCoeff(), command * (1.0 + rounding));
  const MatrixX change =
      run.command.bottomRows(run.command.rows() - 1) - run.command.topRows(run.command.rows() - 1);
  EXPECT_LE(change.cwiseAbs().maxCoeff() / 0.01, rate * (1.0 + rounding));
  // All limits are reached, so the test is meaningful, and the tip still reaches the goal.
  EXPECT_GT(run.volume.maxCoeff(), volume * 0.999);
  EXPECT_GT(run.command.maxCoeff(), command * 0.999);
  EXPECT_GT(change.cwiseAbs().maxCoeff() / 0.01, rate * 0.999);
  const Replay after = replay(arm, task, run);
  for (Eigen::Index u = 0; u < 4; ++u) {
    EXPECT_LE(after.torque.col(u).cwiseAbs().maxCoeff(), 1.001 * task.limits.torque_upper[u]);
  }
  EXPECT_LT(after.tip_error, 3e-3);
}

TEST(DrivePlan, CostsMoreTheSlowerTheCylindersAre) {
  const auto arm = make(pcc::testing::fluidic());
  PlanTask task = grab(kGoals[1]);
  double before = 0.0;
  for (const double frequency : {80.0, 40.0, 15.0}) {
    task.drive = drive(frequency);
    task.objective.command = 1e-7;
    const Plan found = Planner(arm, task).plan(1);
    ASSERT_TRUE(found.found());
    EXPECT_GT(found.objective, before) << frequency;
    before = found.objective;
  }
}

TEST(DrivePlan, BeginsAtATorqueHeld) {
  const auto arm = make(pcc::testing::fluidic());
  PlanTask task = driven(kGoals[1], 30.0);
  // The lead is a whole number of samples, so that one sample is at the beginning of the plan.
  for (DriveChannel& channel : task.drive->channels) channel.actuator.delay = 0.08;
  task.start.torque = VectorX{{0.0, 0.02, -0.03, 0.04}};
  pcc::ArmSimulation simulation(arm, {.time_step = 5e-3});
  for (int i = 0; i < 4000; ++i) simulation.step(task.start.torque);
  task.start.position = simulation.position();
  Planner planner(arm, task);
  const Plan found = planner.plan(1);
  ASSERT_TRUE(found.found());
  const DriveRun& run = *found.knots.drive;
  EXPECT_LT((run.torque(-kLead) - task.start.torque).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT((run.torque(0.0) - task.start.torque).cwiseAbs().maxCoeff(), 1e-14);
  const Replay after = replay(arm, task, run);
  EXPECT_LT(after.tip_error, 3e-3);
  EXPECT_LT(after.tip_speed, 1e-2);
  // Replans for a nearby goal.
  task.goal.position += Vector3(0.01, 0.0, 0.0);
  const Plan next = Planner(arm, task).replan(found);
  ASSERT_TRUE(next.found());
  EXPECT_LT(replay(arm, task, *next.knots.drive).tip_error, 3e-3);
  EXPECT_EQ(kind_of([&] { planner.plan(Planner(arm, grab()).guess(1)); }), ErrorKind::wrong_length);
}

}  // namespace
}  // namespace sinew::plan
