// The two inverse problems, snapshot updates, and missing updates.
#include "sinew/high_rate/high_rate_step.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

#include "../support/allocation_guard.hpp"
#include "../support/error_kind.hpp"
#include "snapshots.hpp"
#include "walls.hpp"

namespace sinew::high_rate {
namespace {

using sinew::testing::add_sensors;
using sinew::testing::kind_of;
using sinew::testing::random_snapshot;
using sinew::testing::robot_settings;
using sinew::testing::spread;
using sinew::testing::wall;
using sinew::testing::wall_settings;

// A robot without contacts.
HighRateSettings free_settings() { return robot_settings(0, 0); }

VectorX random_forces(Eigen::Index count, double size, Random& random) {
  VectorX forces(count);
  for (double& force : forces) force = size * spread(random);
  return forces;
}

TEST(HighRateStep, FindsTheForcesThatSensorsSee) {
  HighRateSettings settings = free_settings();
  add_sensors(settings);
  Random random(1);
  const Snapshot given = random_snapshot(settings, random);
  const VectorX driven = VectorX::Constant(8, 3.0);
  const VectorX unknown = random_forces(3, 2.0, random);
  VectorX efforts = VectorX::Zero(given.rows());
  efforts << driven, unknown, VectorX::Zero(6);
  const VectorX motion = given.free + given.compliance * efforts;

  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  input.driven = driven;
  for (std::size_t s = 0; s < settings.sensors.size(); ++s) {
    input.sensors[static_cast<Eigen::Index>(s)] = motion[settings.sensors[s].row];
  }
  Snapshot fresh = given;
  const HighRateOutput& output = step.step(&fresh, input, {});
  EXPECT_EQ(output.state, HighRateState::running);
  EXPECT_LT((output.unknown - unknown).norm(), 1e-3) << "what the prior draws";

  // The same estimate as a stacked least-squares problem.
  MatrixX rows = MatrixX::Zero(17, 3);
  VectorX right = VectorX::Zero(17);
  for (std::size_t s = 0; s < settings.sensors.size(); ++s) {
    const auto k = static_cast<Eigen::Index>(s);
    const int row = settings.sensors[s].row;
    rows.row(k) = given.compliance.row(row).segment(8, 3) / 1e-6;
    right[k] =
        (motion[row] - given.free[row] - given.compliance.row(row).head(8).dot(driven)) / 1e-6;
  }
  rows.bottomRows(3) = MatrixX::Identity(3, 3) / 2.0;
  EXPECT_LT((output.unknown - rows.colPivHouseholderQr().solve(right)).norm(), 1e-9);
  const MatrixX covariance = (rows.transpose() * rows).inverse();
  EXPECT_LT((output.deviation - covariance.diagonal().cwiseSqrt()).norm(), 1e-9);
}

// Twelve contacts and a hand respond to the force that is to be estimated.
TEST(HighRateStep, FindsForcesOfARobotThatTouches) {
  HighRateSettings settings = robot_settings(1, 12);
  add_sensors(settings);
  Random random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Snapshot given = random_snapshot(settings, random);
    TouchLaw law(settings);
    law.begin(given);
    VectorX driving(11);
    driving << VectorX::Constant(8, 2.0), random_forces(3, 2.0, random);
    const VectorX hands = VectorX::Constant(1, 1e-3);
    law.settle(driving, hands);
    const VectorX motion = law.free() + law.compliance() * driving;

    HighRateStep step(settings);
    HighRateInput input = HighRateInput::none(settings);
    input.driven = driving.head(8);
    input.hands = hands;
    for (std::size_t s = 0; s < settings.sensors.size(); ++s) {
      input.sensors[static_cast<Eigen::Index>(s)] = motion[settings.sensors[s].row];
    }
    Snapshot fresh = given;
    step.step(&fresh, input, {});
    for (int k = 0; k < 30; ++k) step.step(nullptr, input, {});
    EXPECT_LT((step.output().unknown - driving.tail(3)).norm(), 2e-3) << trial;
  }
}

TEST(HighRateStep, SensorsThatDoNotSpeakLeaveThePrior) {
  HighRateSettings settings = free_settings();
  add_sensors(settings);
  Random random(3);
  Snapshot snapshot = random_snapshot(settings, random);
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  input.sensors[0] = 0.0;
  const HighRateOutput& one = step.step(&snapshot, input, {});
  EXPECT_LT(one.deviation.minCoeff(), 1.9) << "one sensor sees one direction";
  EXPECT_GT(one.deviation.maxCoeff(), 1.0) << "and no more than one";
}

TEST(HighRateStep, DrivesTasksToTheirTargetsWithinLimits) {
  HighRateSettings settings = free_settings();
  settings.largest_step = 1.0;
  Random random(4);
  const Snapshot given = random_snapshot(settings, random);
  const VectorX efforts = VectorX::Constant(8, 5.0);
  const VectorX goal = given.free.segment(11, 3) + given.compliance.block(11, 0, 3, 8) * efforts;
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  input.targets = goal;
  Snapshot fresh = given;
  step.step(&fresh, input, {});
  for (int k = 0; k < 20; ++k) step.step(nullptr, input, {});
  const HighRateOutput& output = step.output();
  EXPECT_LT((output.tasks - goal).norm(), 1e-7);
  EXPECT_GE(output.driven.minCoeff(), 0.0);
  EXPECT_LE(output.driven.maxCoeff(), 20.0);
  const VectorX motion = given.free.head(8) + given.compliance.topLeftCorner(8, 8) * output.driven;
  EXPECT_LT((output.driven_motion - motion).norm(), 1e-12);
}

TEST(HighRateStep, ARotationIsShortenedByItsAngleWhateverTheRobotsSize) {
  for (const double size : {0.1, 10.0}) {
    HighRateSettings settings = free_settings();
    for (TaskRow& task : settings.tasks) task.turns = true;
    Random random(4);
    Snapshot given = random_snapshot(settings, random);
    given.size = size;
    const VectorX start =
        given.free.segment(11, 3) + given.compliance.middleRows(11, 3) * given.effort;
    const VectorX goal =
        given.free.segment(11, 3) + given.compliance.block(11, 0, 3, 8) * VectorX::Constant(8, 5.0);
    settings.largest_step = 0.5 * (goal - start).norm();  // half way
    HighRateStep step(settings);
    HighRateInput input = HighRateInput::none(settings);
    input.targets = goal;
    step.step(&given, input, {});
    for (int k = 0; k < 20; ++k) step.step(nullptr, input, {});
    EXPECT_LT((step.output().tasks - 0.5 * (start + goal)).norm(), 1e-3 * (goal - start).norm());
  }
}

TEST(HighRateStep, KeepsRatesAndMotionsWithinLimits) {
  HighRateSettings settings = free_settings();
  settings.largest_step = 1.0;
  Random random(5);
  const Snapshot given = random_snapshot(settings, random);
  for (int k = 0; k < 8; ++k) {
    DrivenRow& row = settings.driven[static_cast<std::size_t>(k)];
    row.effort_rate = 100.0;
    row.motion_min = given.free[k] - 1e-3;
    row.motion_max = given.free[k] + 1e-3;
  }
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  input.targets = VectorX::Constant(3, 0.05);
  Snapshot fresh = given;
  VectorX before = VectorX::Zero(8);
  for (int k = 0; k < 300; ++k) {
    const HighRateOutput& output = step.step(k == 0 ? &fresh : nullptr, input, {});
    EXPECT_LE((output.driven - before).cwiseAbs().maxCoeff(), 0.1 + 1e-12);
    EXPECT_LE((output.driven_motion - given.free.head(8)).cwiseAbs().maxCoeff(), 1e-3 + 1e-9);
    EXPECT_FALSE(output.limits_conflict);
    before = output.driven;
  }
  EXPECT_NEAR((step.output().driven_motion - given.free.head(8)).cwiseAbs().maxCoeff(), 1e-3, 1e-6);
}

TEST(HighRateStep, LimitsThatContradictEachOtherAreTold) {
  HighRateSettings settings = free_settings();
  Random random(6);
  const Snapshot given = random_snapshot(settings, random);
  settings.driven[0].motion_min = given.free[0] + 1.0;  // a metre away
  settings.driven[0].motion_max = given.free[0] + 2.0;
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  input.targets.setZero();
  Snapshot fresh = given;
  const HighRateOutput& output = step.step(&fresh, input, {});
  EXPECT_TRUE(output.limits_conflict);
  EXPECT_LE(output.driven.maxCoeff(), 20.0 + 1e-9);
}

TEST(HighRateStep, AHandIsPushedBackWithTheForceAskedFor) {
  HighRateSettings settings = robot_settings(1, 0);
  settings.tasks = {{settings.free_rows(), TaskKind::effort, 1.0}};
  for (DrivenRow& row : settings.driven) row.effort_min = -20.0;
  Random random(7);
  const Snapshot given = random_snapshot(settings, random);
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  input.hands[0] = given.free[settings.free_rows()] + 2e-3;
  input.targets[0] = 1.5;
  Snapshot fresh = given;
  step.step(&fresh, input, {});
  for (int k = 0; k < 50; ++k) step.step(nullptr, input, {});
  EXPECT_NEAR(step.output().hands[0], 1.5, 1e-6);
  input.hands[0] = std::nan("");
  EXPECT_EQ(step.step(nullptr, input, {}).hands[0], 0.0);
}

// Contacts open and close during the motion; the efforts settle according to the laws.
TEST(HighRateStep, SettlesAmongContacts) {
  const HighRateSettings settings = robot_settings(0, 12);
  Random random(8);
  for (int trial = 0; trial < 30; ++trial) {
    const Snapshot given = random_snapshot(settings, random, trial % 2 == 0 ? 0.3 : 0.0);
    HighRateStep step(settings);
    HighRateInput input = HighRateInput::none(settings);
    input.targets = random_forces(3, 3e-3, random);
    Snapshot fresh = given;
    step.step(&fresh, input, {});
    for (int k = 0; k < 400; ++k) step.step(nullptr, input, {});
    VectorX before = step.output().driven;
    step.step(nullptr, input, {});
    EXPECT_LT((step.output().driven - before).norm(), 1e-6 * (1.0 + before.norm())) << trial;
    EXPECT_LT(step.output().law_residual, 1e-6) << trial;
  }
}

// One wall replaces another: at the same position, the force changes from one to the other in equal
// parts.
TEST(HighRateStep, ARefreshComesThroughInParts) {
  HighRateSettings settings = wall_settings();
  settings.blend = 5e-3;
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  input.hands[0] = 2e-3;
  Snapshot first = wall(1000.0), second = wall(1100.0);
  step.step(&first, input, {});
  for (int k = 0; k < 10; ++k) step.step(nullptr, input, {});
  double before = step.output().hands[0];
  EXPECT_NEAR(before, 2.0, 1e-8);
  for (int k = 0; k < 6; ++k) {
    const HighRateOutput& output = step.step(k == 0 ? &second : nullptr, input, {});
    EXPECT_NEAR(output.hands[0] - before, 0.2 / 6.0, 1e-8) << k;
    EXPECT_NEAR(output.jump, 0.2 / 6.0, 1e-8);
    before = output.hands[0];
  }
  EXPECT_NEAR(before, 2.2, 1e-8) << "after 5 ms it counts fully";
  EXPECT_EQ(step.step(nullptr, input, {}).jump, 0.0);
}

// Updates at 100 Hz of a stiffening wall, k x + k_3 x^3 with twice the stiffness at 10 mm,
// linearised at the hand's position 10 ms before.
TEST(HighRateStep, RefreshesOfAStiffeningWallAreFelt) {
  const HighRateSettings settings = wall_settings();
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  const sinew::testing::SeededHand hand(3);
  const auto force = [](double x) { return 1000.0 * x + 1e7 / 3.0 * x * x * x; };
  const auto tangent = [&](double x) {
    x = std::max(x, 0.0);
    Snapshot snapshot = wall(1000.0 + 1e7 * x * x);
    snapshot.free[0] = x - force(x) * snapshot.compliance(0, 0);
    return snapshot;
  };
  double largest = 0.0, load = 0.0;
  for (int k = 0; k < 60000; ++k) {
    input.hands[0] = hand.at(1e-3 * k);
    Snapshot snapshot = tangent(hand.at(1e-3 * (k - 10)));
    const HighRateOutput& output = step.step(k % 10 == 0 ? &snapshot : nullptr, input, {});
    largest = std::max(largest, output.jump);
    load = std::max(load, output.hands[0]);
  }
  RecordProperty("largest_jump_of_load", std::to_string(largest / load));
  EXPECT_LT(largest, 0.02 * load);
  EXPECT_GT(largest, 1e-4 * load);
  EXPECT_LE(step.output().energy_created, 0.0);
}

TEST(HighRateStep, HoldsAndLetsGoWithoutNews) {
  HighRateSettings settings = robot_settings(1, 0);
  settings.largest_step = 1.0;
  settings.driven[0].release = 1.0;
  add_sensors(settings);
  Random random(9);
  const Snapshot given = random_snapshot(settings, random);
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  input.sensors.setZero();
  input.targets.setConstant(3e-3);
  input.hands[0] = given.free[settings.free_rows()] + 3e-3;
  Snapshot fresh = given;
  EXPECT_EQ(step.output().state, HighRateState::waiting);
  EXPECT_EQ(step.step(nullptr, input, {}).driven[0], 1.0) << "released before the first snapshot";
  step.step(&fresh, input, {});
  for (int k = 0; k < 100; ++k) step.step(nullptr, input, {1e-3 * k, 0.0});
  const HighRateOutput held = step.output();
  EXPECT_EQ(held.state, HighRateState::running);
  EXPECT_EQ(held.cause, StaleCause::none);
  input.targets.setConstant(-3e-3);  // no longer followed
  for (int k = 101; k <= 200; ++k) {
    const HighRateOutput& output = step.step(nullptr, input, {1e-3 * k, 0.0});
    EXPECT_EQ(output.state, HighRateState::holding);
    EXPECT_EQ(output.cause, StaleCause::snapshot);
    EXPECT_EQ(output.driven, held.driven);
    EXPECT_NEAR(output.hands[0], held.hands[0], 1e-9);
  }
  VectorX before = held.driven;
  for (int k = 201; k <= 699; ++k) {
    const HighRateOutput& output = step.step(nullptr, input, {1e-3 * k, 0.0});
    EXPECT_EQ(output.state, HighRateState::releasing) << k;
    EXPECT_LT((output.driven - before).cwiseAbs().maxCoeff(), 20.0 / 500.0 + 1e-9);
    before = output.driven;
  }
  for (int k = 700; k < 710; ++k) step.step(nullptr, input, {1e-3 * k, 0.0});
  EXPECT_EQ(step.output().state, HighRateState::released);
  EXPECT_EQ(step.output().driven[0], 1.0);
  EXPECT_EQ(step.output().driven.tail(7).norm(), 0.0);
  EXPECT_EQ(step.output().hands[0], 0.0);
  // A new snapshot: the efforts return along the same ramp.
  before = step.output().driven;
  fresh = given;
  fresh.number = 2;
  input.targets.setConstant(3e-3);
  for (int k = 0; k < 600; ++k) {
    const HighRateOutput& output = step.step(k == 0 ? &fresh : nullptr, input, {1e-3, 0.0});
    EXPECT_EQ(output.state, HighRateState::running);
    EXPECT_LT((output.driven - before).cwiseAbs().maxCoeff(), 0.5) << k;
    before = output.driven;
  }
  EXPECT_LT((before - held.driven).norm(), 1e-2 * held.driven.norm());
}

TEST(HighRateStep, NoticesDeafSensorsAndOldInput) {
  HighRateSettings settings = robot_settings(1, 0);
  add_sensors(settings);
  Random random(10);
  Snapshot snapshot = random_snapshot(settings, random);
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  input.sensors.setZero();
  step.step(&snapshot, input, {});
  step.step(nullptr, input, {0.0, 0.15});
  EXPECT_EQ(step.output().state, HighRateState::holding);
  EXPECT_EQ(step.output().cause, StaleCause::input);
  step.step(nullptr, input, {0.0, 0.0});
  EXPECT_EQ(step.output().state, HighRateState::running);
  input.sensors.setConstant(std::nan(""));
  for (int k = 0; k < 99; ++k) step.step(nullptr, input, {});
  EXPECT_EQ(step.output().state, HighRateState::running);
  for (int k = 0; k < 2; ++k) step.step(nullptr, input, {});
  EXPECT_EQ(step.output().state, HighRateState::holding);
  EXPECT_EQ(step.output().cause, StaleCause::sensors);
}

TEST(HighRateStep, AllocatesNothing) {
  if (!sinew::testing::counts_allocations()) return;
  HighRateSettings settings = robot_settings(2, 12);
  add_sensors(settings);
  Random random(11);
  std::vector<Snapshot> snapshots;
  for (std::uint64_t k = 0; k < 20; ++k) snapshots.push_back(random_snapshot(settings, random));
  HighRateStep step(settings);
  HighRateInput input = HighRateInput::none(settings);
  input.sensors.setZero();
  const auto run = [&](int first, int last) {
    for (int k = first; k < last; ++k) {
      for (int h = 0; h < 2; ++h) input.hands[h] = 2e-3 * std::sin(0.1 * k + h);
      for (int t = 0; t < 3; ++t) input.targets[t] = 2e-3 * std::sin(0.07 * k + t);
      step.step(k % 10 == 0 ? &snapshots[static_cast<std::size_t>(k / 10)] : nullptr, input, {});
    }
  };
  const std::vector<Snapshot> again = snapshots;
  run(0, 200);  // the cone solver's buffers grow
  snapshots = again;
  const long before = sinew::testing::allocations();
  run(0, 200);
  EXPECT_EQ(sinew::testing::allocations(), before);
  EXPECT_GT(step.law().cone_solutions(), 0);
}

// The same inputs give the same results, bit for bit.
TEST(HighRateStep, IsDeterministic) {
  HighRateSettings settings = robot_settings(1, 12);
  add_sensors(settings);
  const auto run = [&] {
    Random random(12);
    HighRateStep step(settings);
    HighRateInput input = HighRateInput::none(settings);
    for (int k = 0; k < 200; ++k) {
      Snapshot snapshot = random_snapshot(settings, random);
      input.sensors = 1e-3 * random_forces(14, 1.0, random);
      input.targets = 1e-3 * random_forces(3, 1.0, random);
      input.hands[0] = 1e-3 * spread(random);
      step.step(k % 10 == 0 ? &snapshot : nullptr, input, {});
    }
    VectorX all(12);
    all << step.output().driven, step.output().unknown, step.output().hands;
    return all;
  };
  EXPECT_EQ(run(), run());
}

TEST(HighRateSettings, NamesWhatIsWrong) {
  const auto refused = [](const auto& change) {
    HighRateSettings settings = robot_settings(1, 2);
    add_sensors(settings);
    change(settings);
    return kind_of([&] { HighRateStep step(settings); });
  };
  using enum ErrorKind;
  EXPECT_EQ(refused([](auto& s) { s.period = 0.0; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.period = std::nan(""); }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.blend = -1.0; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.stale_after = 0.0; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.release_time = -0.1; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.epsilon = 0.0; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.max_contacts = -1; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.driven[2].effort_rate = 0.0; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.driven[2].effort_min = 30.0; }), contradictory_limits);
  EXPECT_EQ(refused([](auto& s) { s.driven[2].release = -1.0; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.unknown[0].prior = 0.0; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.hands[0].min = 1.0; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.sensors[0].row = 17; }), index_out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.sensors[0].noise = 0.0; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.tasks[0].row = -1; }), index_out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.tasks[0].kind = TaskKind::effort; }), index_out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.tasks[0].weight = -1.0; }), out_of_range);
}

TEST(Snapshot, NamesWhatIsWrong) {
  const HighRateSettings settings = robot_settings(1, 2);
  Random random(13);
  const Snapshot good = random_snapshot(settings, random);
  EXPECT_NO_THROW(check(good, settings));
  const auto refused = [&](const auto& change) {
    Snapshot snapshot = good;
    change(snapshot);
    return kind_of([&] { check(snapshot, settings); });
  };
  using enum ErrorKind;
  EXPECT_EQ(refused([](auto& s) { s.free.conservativeResize(s.rows() - 1); }), wrong_shape);
  EXPECT_EQ(refused([](auto& s) { s.friction.push_back(0.1); }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.friction.pop_back(); }), wrong_shape);
  EXPECT_EQ(refused([](auto& s) { s.compliance(0, 1) = std::nan(""); }), not_finite);
  EXPECT_EQ(refused([](auto& s) { s.friction[0] = -0.1; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.size = 0.0; }), out_of_range);
  EXPECT_EQ(refused([](auto& s) { s.compliance(17, 17) = 0.0; }), out_of_range);
}

}  // namespace
}  // namespace sinew::high_rate
