// Inversion of volumes and planned torques to commands of drive cylinders.
#include "sinew/plan/drive_inversion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sinew/core/random.hpp"

#include "support/error_kind.hpp"

namespace sinew::plan {
namespace {

using pcc::DriveCylinder;
using qp::QpStatus;
using sinew::testing::kind_of;

constexpr double kStep = 0.01;

DriveCylinder cylinder_of(double frequency = 40.0) {
  return DriveCylinder::second_order(1.1, frequency, 0.8, kStep);
}

/// Smooth commands of about 3e-5 m^3.
VectorX commands(int count) {
  VectorX u(count);
  for (int k = 0; k < count; ++k) {
    const double t = kStep * k;
    u[k] = 2e-5 * std::sin(5.0 * t) + 1.5e-5 * std::sin(11.0 * t + 1.0);
  }
  return u;
}

/// A plan with one input, whose torque rises and falls, linear between knots.
Plan swing(double size = 0.15) {
  constexpr int kIntervals = 50;
  Plan plan;
  plan.knots.times = VectorX::LinSpaced(kIntervals + 1, 0.0, 1.6);
  plan.knots.torque = MatrixX(kIntervals + 1, 1);
  for (int k = 0; k <= kIntervals; ++k) {
    plan.knots.torque(k, 0) = size * std::sin(1.5 * std::numbers::pi * k / kIntervals);
  }
  return plan;
}

TEST(CylinderInversion, FindsCommandsBackWhereNoLimitBinds) {
  for (const double feedthrough : {0.0, 0.2}) {
    DriveCylinder cylinder = cylinder_of();
    cylinder.d = feedthrough;
    const Eigen::Vector2d start(1e-5, -5e-6);
    const VectorX u = commands(150);
    const VectorX volume = cylinder.simulate(u, start);
    const CylinderInversion found = invert_cylinder(cylinder, volume, {start, 1e-11});
    ASSERT_EQ(found.status, QpStatus::optimal);
    EXPECT_LT((found.volume - volume).cwiseAbs().maxCoeff(), 1e-7 * volume.cwiseAbs().maxCoeff());
    // Without feedthrough, the last command does not affect any volume.
    EXPECT_LT((found.command - u).head(149).cwiseAbs().maxCoeff(), 1e-3 * u.cwiseAbs().maxCoeff());
    EXPECT_LT((cylinder.simulate(found.command, start) - found.volume).cwiseAbs().maxCoeff(),
              1e-12 * volume.cwiseAbs().maxCoeff());
  }
}

TEST(CylinderInversion, KeepsLimits) {
  DriveCylinder cylinder = cylinder_of();
  cylinder.lowest_input = -5e-5;
  cylinder.highest_input = 4e-5;
  cylinder.lowest_volume = -2.5e-5;
  cylinder.highest_volume = 3e-5;
  VectorX volume = VectorX::Constant(120, -4e-5);  // beyond its limits, with a jump
  volume.segment(20, 50).setConstant(4e-5);
  const CylinderInversion found = invert_cylinder(cylinder, volume);
  ASSERT_EQ(found.status, QpStatus::optimal);
  const double rounding = 1e-9 * 4e-5;
  EXPECT_LE(found.command.maxCoeff(), cylinder.highest_input + rounding);
  EXPECT_GE(found.command.minCoeff(), cylinder.lowest_input - rounding);
  EXPECT_LE(found.volume.maxCoeff(), cylinder.highest_volume + rounding);
  EXPECT_GE(found.volume.minCoeff(), cylinder.lowest_volume - rounding);
  // All four limits are reached, so the test is meaningful.
  EXPECT_NEAR(found.command.maxCoeff(), cylinder.highest_input, rounding);
  EXPECT_NEAR(found.command.minCoeff(), cylinder.lowest_input, rounding);
  EXPECT_NEAR(found.volume.maxCoeff(), cylinder.highest_volume, rounding);
  EXPECT_NEAR(found.volume.minCoeff(), cylinder.lowest_volume, rounding);
  EXPECT_LT((cylinder.simulate(found.command) - found.volume).cwiseAbs().maxCoeff(), rounding);
}

/// No small change of the commands within their limits reduces the error of the volumes.
TEST(CylinderInversion, IsLeast) {
  DriveCylinder cylinder = cylinder_of();
  cylinder.lowest_input = -4e-5;
  cylinder.highest_input = 4e-5;
  const double smoothing = 1e-4;
  VectorX volume = VectorX::Constant(60, -3e-5);
  volume.tail(30).setConstant(3e-5);
  const auto cost = [&](const VectorX& u) {
    const VectorX y = cylinder.simulate(u);
    const auto changes = u.tail(u.size() - 1) - u.head(u.size() - 1);
    return (volume - y).squaredNorm() +
           smoothing * cylinder.gain() * cylinder.gain() * changes.squaredNorm();
  };
  const CylinderInversion found = invert_cylinder(cylinder, volume, {.smoothing = smoothing});
  ASSERT_EQ(found.status, QpStatus::optimal);
  const double least = cost(found.command);
  Random random(7);
  for (int trial = 0; trial < 300; ++trial) {
    VectorX u = found.command;
    for (double& value : u) {
      value = std::clamp(value + 1e-7 * random.uniform(-1.0, 1.0), -4e-5, 4e-5);
    }
    EXPECT_GE(cost(u), least * (1.0 - 1e-9)) << trial;
  }
}

TEST(CylinderInversion, SaysWhereNoCommandKeepsTheLimits) {
  DriveCylinder cylinder = cylinder_of();
  cylinder.lowest_volume = -1e-5;
  cylinder.highest_volume = 1e-5;
  cylinder.lowest_input = -1e-5;
  cylinder.highest_input = 1e-5;
  const Eigen::Vector2d moving(0.9e-5, 2e-5);
  EXPECT_EQ(invert_cylinder(cylinder, VectorX::Zero(50), {.start = moving}).status,
            QpStatus::infeasible);
}

TEST(DriveInversion, TorqueActsFromTheLeadOn) {
  const Plan plan = swing();
  const double lead = 0.3, delay = 0.077;
  const DriveChannel channel{{800.0, 4e12, delay}, cylinder_of(200.0)};
  const DriveInversion found = invert_drive(plan, {channel}, lead, {.smoothing = 1e-9});
  ASSERT_TRUE(found.found);
  EXPECT_DOUBLE_EQ(found.times[found.times.size() - 1], 1.9);
  double worst = 0.0;
  for (Eigen::Index k = 0; k < found.times.size(); ++k) {
    // The volume at t acts at t + delay, which is t + delay - lead in the plan.
    const double torque = channel.actuator.torque(found.volume(k, 0));
    worst = std::max(worst, std::abs(torque - plan.torque(found.times[k] + delay - lead)[0]));
    EXPECT_NEAR(channel.actuator.torque(found.wanted(k, 0)),
                plan.torque(found.times[k] + delay - lead)[0], 1e-14);
  }
  EXPECT_LT(worst, 1e-4 * 0.15);
}

TEST(DriveInversion, RefusesWhatCannotBe) {
  const Plan plan = swing();
  const DriveChannel channel{{0.0, 4e12, 0.1}, cylinder_of()};
  DriveChannel other = channel;
  other.cylinder.sample_time = 0.02;
  EXPECT_EQ(kind_of([&] { invert_drive(plan, {}, 0.2); }), ErrorKind::wrong_length);
  EXPECT_EQ(kind_of([&] { invert_drive(plan, {channel}, 0.05); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { invert_drive(plan, {channel}, 0.2, {.smoothing = 0.0}); }),
            ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { invert_cylinder(cylinder_of(), VectorX::Zero(1)); }),
            ErrorKind::too_few_points);
  EXPECT_EQ(kind_of([&] { invert_cylinder(cylinder_of(), VectorX::Constant(9, NAN)); }),
            ErrorKind::not_finite);
  Plan two = plan;
  two.knots.torque = MatrixX::Zero(51, 2);
  EXPECT_EQ(kind_of([&] { invert_drive(two, {channel, other}, 0.2); }), ErrorKind::out_of_range);
}

}  // namespace
}  // namespace sinew::plan
