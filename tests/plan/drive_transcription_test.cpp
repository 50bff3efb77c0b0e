// Drives in the program of a plan: rows, volumes, bounds, and effects of commands.
#include "sinew/plan/drive_transcription.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/error_kind.hpp"
#include "tasks.hpp"

namespace sinew::plan {
namespace {

using sinew::testing::kind_of;
using testing::grab;
using testing::make;

constexpr double kDriveStep = 0.01;

/// Drives for the four inputs of the published arm, of which the first has no torque.
PlanTask driven(double lead = -1.0) {
  PlanTask task = grab();
  DriveTrain drive;
  drive.lead = lead;
  for (const double delay : {0.0, 0.033, 0.05, 0.0771}) {
    DriveChannel channel{{10.0, 4e12, delay},
                         pcc::DriveCylinder::second_order(1.1, 40.0, 0.8, kDriveStep)};
    channel.cylinder.lowest_input = -8e-5;
    channel.cylinder.highest_input = 8e-5;
    channel.cylinder.lowest_volume = -3.2e-5;
    drive.channels.push_back(channel);
  }
  drive.channels[2].cylinder.d = 0.2;
  task.drive = drive;
  return completed(*make(pcc::testing::fluidic()), task);
}

/// Smooth commands from rest, starting with the plan.
DriveRun commands(const PlanTask& task) {
  const Eigen::Index count =
      sample_count(task.drive->channels[0].cylinder, task.drive->lead + task.grid.duration) + 3;
  MatrixX command = MatrixX::Zero(count, 4);
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index i = 1; i < 4; ++i) {
      const double delay = task.drive->channels[static_cast<std::size_t>(i)].actuator.delay;
      const double time = std::max(
          0.0, static_cast<double>(k) * kDriveStep - task.drive->lead + delay - 1.01 * kDriveStep);
      command(k, i) = 2e-5 * std::sin((5.0 + static_cast<double>(i)) * time);
    }
  }
  return {task.drive->channels, command, task.drive->lead};
}

VectorX rows_at(const DriveTranscription& drive, const VectorX& x, int first) {
  VectorX rows = VectorX::Zero(drive.rows());
  for (const auto& [row, column, value] : drive.jacobian()) rows[row - first] += value * x[column];
  return rows;
}

TEST(SampleWeights, AreExactOnParabolas) {
  for (const double s : {0.0, 0.2, 0.5, 1.0}) {
    const auto weights = sample_weights(s);
    for (int power = 0; power < 3; ++power) {
      double sum = 0.0;
      for (int m = 0; m < 4; ++m) {
        sum += weights[static_cast<std::size_t>(m)] * std::pow(m - 1.0, power);
      }
      EXPECT_NEAR(sum, std::pow(s, power), 1e-15) << s << " " << power;
    }
  }
}

/// The simulated cylinders satisfy the rows, in which their states are eliminated, for any lead.
TEST(DriveTranscription, RowsAreTheCylinders) {
  for (const double lead : {-1.0, 0.0771, 0.25}) {
    const PlanTask task = driven(lead);
    const int variable = 7, row = 3;
    const DriveTranscription drive(task, 0.1, variable, row);
    const DriveRun run = commands(task);
    VectorX x = VectorX::Zero(variable + drive.variables());
    x.tail(drive.variables()) = drive.pack(run);
    EXPECT_LT(rows_at(drive, x, row).cwiseAbs().maxCoeff(), 1e-18) << lead;
    // A different volume violates the rows.
    VectorX wrong = x;
    wrong[drive.volume(1, 0.8).at[1]] += 1e-6;
    EXPECT_GT(rows_at(drive, wrong, row).cwiseAbs().maxCoeff(), 1e-7);
    // They satisfy the bounds, which keep samples before the plan at rest.
    const auto own = x.tail(drive.variables());
    EXPECT_TRUE((own.array() >= drive.variable_bounds().lower.array() - 1e-18).all());
    EXPECT_TRUE((own.array() <= drive.variable_bounds().upper.array() + 1e-18).all());
  }
}

/// The delay is a shift of time: the torque at a time in the plan is that at the volume of the
/// linear form.
TEST(DriveTranscription, VolumesActAfterTheDelay) {
  const PlanTask task = driven(0.25);
  const DriveTranscription drive(task, 0.1, 0, 0);
  const DriveRun run = commands(task);
  const VectorX x = drive.pack(run);
  for (const double time : {0.0, 0.1234, 0.8, 1.6}) {
    const VectorX torque = run.torque(time);
    for (int i = 0; i < 4; ++i) {
      const double volume = drive.volume(i, time).of(x);
      const auto& actuator = task.drive->channels[static_cast<std::size_t>(i)].actuator;
      EXPECT_NEAR(actuator.torque(volume), torque[i], 1e-15) << time << " " << i;
    }
  }
  // The volume of the cylinder earlier by the delay.
  const double at = 0.8 + 0.25 - 0.05;
  const auto sample = static_cast<Eigen::Index>(std::lround(at / kDriveStep));
  EXPECT_NEAR(run.torque(0.8)[2], task.drive->channels[2].actuator.torque(run.volume(sample, 2)),
              1e-15);
  // Converts back, for commands that act within the plan.
  const DriveRun back = drive.unpack(x);
  for (Eigen::Index k = 0; k < back.times.size(); ++k) {
    for (Eigen::Index i = 0; i < 4; ++i) {
      const double delay = task.drive->channels[static_cast<std::size_t>(i)].actuator.delay;
      if (back.times[k] + delay > 0.25 + task.grid.duration) continue;
      EXPECT_EQ(back.command(k, i), run.command(k, i)) << k << " " << i;
    }
  }
}

TEST(DriveTranscription, BoundsAreThoseOfTorqueAndVolume) {
  const PlanTask task = driven();
  const DriveTranscription drive(task, 0.1, 0, 0);
  const auto& lower = drive.variable_bounds().lower;
  const auto& upper = drive.variable_bounds().upper;
  for (int i = 0; i < 4; ++i) {
    const int at = drive.volume(i, 1.0).at[1];
    const auto& actuator = task.drive->channels[static_cast<std::size_t>(i)].actuator;
    const double most = task.limits.torque_upper[i];
    EXPECT_NEAR(actuator.torque(upper[at]), most, 1e-14);
    EXPECT_NEAR(actuator.torque(lower[at]), std::max(-most, actuator.torque(-3.2e-5)), 1e-14);
  }
}

TEST(DriveTranscription, RefusesWhatCannotBe) {
  const auto arm = make(pcc::testing::fluidic());
  const PlanTask good = driven();
  EXPECT_DOUBLE_EQ(good.drive->lead, 0.08);
  const auto kind = [&](auto change) {
    PlanTask task = good;
    change(task);
    return kind_of([&] { completed(*arm, task); });
  };
  EXPECT_EQ(kind([](PlanTask& t) { t.drive->channels.pop_back(); }), ErrorKind::wrong_length);
  EXPECT_EQ(kind([](PlanTask& t) { t.drive->lead = 0.05; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](PlanTask& t) { t.drive->channels[1].cylinder.sample_time = 0.02; }),
            ErrorKind::out_of_range);
  EXPECT_EQ(kind([](PlanTask& t) { t.drive->channels[1].cylinder.c.setZero(); }),
            ErrorKind::out_of_range);
  EXPECT_EQ(kind([](PlanTask& t) { t.grid.min_duration = t.grid.max_duration = 2.0; }),
            ErrorKind::contradictory_limits);
  EXPECT_EQ(kind([](PlanTask& t) { t.objective.command = 0.0; }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](PlanTask& t) { t.limits.command_rate.setZero(); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind([](PlanTask& t) { t.start.torque[3] = -0.17; }), ErrorKind::contradictory_limits);
}

TEST(DriveRun, RefusesWhatDoesNotFit) {
  const PlanTask task = driven();
  const auto& channels = task.drive->channels;
  EXPECT_EQ(kind_of([&] { DriveRun(channels, MatrixX::Zero(9, 3), 0.1); }),
            ErrorKind::wrong_length);
  EXPECT_EQ(kind_of([&] { DriveRun(channels, MatrixX::Zero(1, 4), 0.1); }),
            ErrorKind::wrong_length);
  EXPECT_EQ(kind_of([&] { DriveRun(channels, MatrixX::Zero(9, 4), 0.01); }),
            ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { DriveRun(channels, MatrixX::Zero(9, 4), 0.1, VectorX::Zero(2)); }),
            ErrorKind::wrong_length);
}

}  // namespace
}  // namespace sinew::plan
