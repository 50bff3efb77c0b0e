#include "sinew/law/direct_solver.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "sinew/law/response.hpp"
#include "sinew/law/step_solver.hpp"

#include "problems.hpp"

namespace sinew::law {
namespace {

using testing::BlockCounts;
using testing::Random;
using testing::random_problem;
using testing::RandomProblem;

BlockCounts random_counts(Random& random) {
  BlockCounts counts;
  counts.owned = random.integer(0, 3);
  counts.commanded_efforts = random.integer(0, 2);
  counts.stopped_efforts = random.integer(0, 2);
  counts.motions = random.integer(0, 3);
  counts.held = random.integer(0, 2);
  counts.drives = random.integer(0, 2);
  counts.capstans = counts.motions + counts.owned > 0 ? random.integer(0, 2) : 0;
  counts.contacts = random.integer(0, 3);
  counts.bilaterals = random.integer(0, 2);
  counts.effectors = random.integer(0, 3);
  return counts;
}

// Every block obeys its law for the resulting motion, whatever other blocks there are.
TEST(DirectSolver, AnyBlocksObeyTheirLawsTogether) {
  Random random(5);
  int solved = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    RandomProblem robot = random_problem(random_counts(random), random);
    const auto rows = static_cast<std::size_t>(robot.problem.delta_free.size());
    std::vector<double> effort(rows, 0.0);
    for (const ActuatorBlock& block : robot.problem.actuators) {
      if (block.owned) effort[static_cast<std::size_t>(block.row)] = random.uniform(0.0, 1.0);
    }
    const std::vector<double> start = effort;
    DirectSolver solver;
    solver.begin_step();
    ASSERT_EQ(solver.solve(robot.problem, effort), LawStatus::solved) << trial;
    robot.problem.delta = robot.motion(effort);
    EXPECT_LT(violation(robot.problem, effort, LawStatus::solved), 1e-8) << trial;
    for (const ActuatorBlock& block : robot.problem.actuators) {
      const auto row = static_cast<std::size_t>(block.row);
      if (block.owned) {
        EXPECT_EQ(effort[row], start[row]) << trial;
      }
    }
    ++solved;
  }
  EXPECT_EQ(solved, 1000);
}

// Without friction the solution is unique, so another start gives the same one.
TEST(DirectSolver, DoesNotDependOnItsStartWithoutFriction) {
  Random random(6);
  for (int trial = 0; trial < 200; ++trial) {
    BlockCounts counts = random_counts(random);
    counts.owned = counts.capstans = 0;
    RandomProblem robot = random_problem(counts, random);
    for (ContactBlock& block : robot.problem.contacts) block.friction = 0.0;
    const auto rows = static_cast<std::size_t>(robot.problem.delta_free.size());
    std::vector<double> first(rows, 0.0), second(rows, 0.0);
    DirectSolver solver;
    solver.begin_step();
    ASSERT_EQ(solver.solve(robot.problem, first), LawStatus::solved);
    for (double& effort : second) effort = random.uniform(-1.0, 1.0);
    for (int row = 0; row < static_cast<int>(rows); ++row) {
      const bool has_block = first[static_cast<std::size_t>(row)] != 0.0;
      if (!has_block) second[static_cast<std::size_t>(row)] = 0.0;
    }
    DirectSolver other;
    other.begin_step();
    ASSERT_EQ(other.solve(robot.problem, second), LawStatus::solved);
    for (std::size_t row = 0; row < rows; ++row) {
      EXPECT_NEAR(first[row], second[row], 1e-6 * (1.0 + std::abs(first[row]))) << trial;
    }
  }
}

// Motions of the contact rows for given contact forces, while all other blocks obey their laws.
VectorX contact_motion(const RandomProblem& robot, std::vector<double> effort,
                       const VectorX& forces) {
  StepProblem rest = robot.problem;
  rest.contacts.clear();
  const int first = robot.problem.contacts.front().row;
  for (Eigen::Index k = 0; k < forces.size(); ++k) {
    rest.delta_free += forces[k] * rest.compliance.col(first + k);
    effort[static_cast<std::size_t>(first + k)] = 0.0;
  }
  DirectSolver solver;
  solver.begin_step();
  EXPECT_EQ(solver.solve(rest, effort), LawStatus::solved);
  const Eigen::Map<const VectorX> all(effort.data(), rest.delta_free.size());
  return (rest.delta_free + rest.compliance * all).segment(first, forces.size());
}

// The reduced problem of the contacts has the efforts and motions of the step; its W includes the
// response of all other blocks.
TEST(DirectSolver, ContactsByThemselvesAreThoseOfTheStep) {
  Random random(7);
  for (int trial = 0; trial < 300; ++trial) {
    BlockCounts counts = random_counts(random);
    counts.contacts = random.integer(1, 4);
    if (trial % 2 == 0) counts.capstans = 0;
    const RandomProblem robot = random_problem(counts, random);
    std::vector<double> effort(static_cast<std::size_t>(robot.problem.delta_free.size()), 0.0);
    DirectSolver solver;
    solver.begin_step();
    ASSERT_EQ(solver.solve(robot.problem, effort), LawStatus::solved) << trial;
    const ContactProblem alone = solver.contact_problem();
    const VectorX motion = alone.compliance * alone.effort + alone.motion;
    const VectorX expected = robot.motion(effort);
    ASSERT_EQ(alone.friction.size(), robot.problem.contacts.size());
    for (std::size_t k = 0; k < alone.friction.size(); ++k) {
      const ContactBlock& block = robot.problem.contacts[k];
      const auto own = static_cast<Eigen::Index>(3 * k);
      EXPECT_EQ(alone.friction[k], block.friction);
      EXPECT_LT((motion.segment<3>(own) - expected.segment<3>(block.row)).norm(), 1e-8) << trial;
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(alone.effort[own + c], effort[static_cast<std::size_t>(block.row + c)]);
      }
    }
    if (counts.capstans > 0) continue;  // friction limits would follow the tensions
    const double step = 1e-5;
    const VectorX turn = random.vector(static_cast<int>(alone.effort.size()));
    const VectorX slope = (contact_motion(robot, effort, alone.effort + step * turn) -
                           contact_motion(robot, effort, alone.effort - step * turn)) /
                          (2.0 * step);
    EXPECT_LT((slope - alone.compliance * turn).norm(), 1e-4 * (1.0 + slope.norm())) << trial;
  }
}

// Identical rows that are held at one motion share the effort evenly.
TEST(DirectSolver, TwinHeldRowsShareTheEffort) {
  StepProblem problem;
  problem.compliance = MatrixX::Constant(2, 2, 0.5);
  problem.delta_free = VectorX::Constant(2, -1.0);
  problem.delta = problem.delta_free;
  problem.bilaterals = {{0, 0.0, 1.0}, {1, 0.0, 1.0}};
  std::vector<double> effort(2, 0.0);
  DirectSolver solver;
  ASSERT_EQ(solver.solve(problem, effort), LawStatus::solved);
  EXPECT_NEAR(effort[0], 1.0, 1e-12);
  EXPECT_NEAR(effort[1], 1.0, 1e-12);
}

// Rows with commanded motions and effort limits, on a body that is held by welds only. With an
// anchor, W = c U U^T + (left, 0; 0, 0) with c = -1e5; after elimination of the welds' rows, `left`
// remains of it.
// @param rows (n,) the row of `left` that each row repeats.
StepProblem behind_welds(const MatrixX& left, const VectorX& free, std::span<const int> rows,
                         Random& random) {
  constexpr double kAnchor = -1e5;
  constexpr int kWelds = 3;
  const Eigen::Index apart = left.rows(), all = apart + kWelds;
  MatrixX ways(all, kWelds);
  for (double& way : ways.topRows(apart).reshaped()) way = random.uniform(-1.0, 1.0);
  ways.bottomRows(kWelds).setIdentity();
  MatrixX whole = kAnchor * ways * ways.transpose();
  whole.topLeftCorner(apart, apart) += left;
  whole = (0.5 * (whole + whole.transpose())).eval();
  std::vector<Eigen::Index> of(rows.begin(), rows.end());
  for (Eigen::Index weld = apart; weld < all; ++weld) of.push_back(weld);
  StepProblem problem;
  problem.compliance = whole(of, of);
  problem.delta_free = VectorX::Zero(static_cast<Eigen::Index>(of.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    problem.delta_free[static_cast<Eigen::Index>(k)] = free[rows[k]];
    ActuatorBlock& block = problem.actuators.emplace_back();
    block.row = static_cast<int>(k);
    block.kind = CommandKind::motion;
    block.motion_min = -kInfinity;
    block.motion_max = kInfinity;
    block.effort_min = -1e3;
    block.effort_max = 1e3;
  }
  for (std::size_t k = rows.size(); k < of.size(); ++k) {
    problem.bilaterals.push_back({static_cast<int>(k), 0.0, 1.0});
  }
  problem.delta = problem.delta_free;
  return problem;
}

VectorX solve_and_obey(StepProblem& problem) {
  std::vector<double> effort(static_cast<std::size_t>(problem.delta.size()), 0.0);
  DirectSolver solver;
  solver.begin_step();
  EXPECT_EQ(solver.solve(problem, effort), LawStatus::solved);
  const Eigen::Map<const VectorX> x(effort.data(), problem.delta.size());
  problem.delta = problem.delta_free + problem.compliance * x;
  EXPECT_LT(violation(problem, effort, LawStatus::solved), 1e-8);
  return x;
}

// A motor and a brake in one hinge, and three cables, in two orders. After elimination the block of
// the twins would be indefinite, because each has its own rounding.
TEST(DirectSolver, TwinsBehindWeldsShareInAnyOrder) {
  Random random(23);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    MatrixX half(4, 6);
    for (double& entry : half.reshaped()) entry = random.uniform(-1.0, 1.0);
    const MatrixX left = half * half.transpose();
    const VectorX free = Eigen::Vector4d(-0.7, 0.2, -0.1, 0.3);
    const std::vector<int> one{0, 1, 2, 3, 0}, other{2, 0, 0, 3, 1};
    StepProblem first = behind_welds(left, free, one, random);
    StepProblem second = behind_welds(left, free, other, random);
    first.actuators[0].effort_max = second.actuators[2].effort_max = 1e-3;
    first.actuators[0].effort_min = second.actuators[2].effort_min = -1e-3;
    const VectorX a = solve_and_obey(first), b = solve_and_obey(second);
    EXPECT_EQ(std::abs(a[0]), 1e-3);
    EXPECT_EQ(a[0], b[2]);
    EXPECT_NEAR(a[4], b[1], 1e-7 * b.norm());
    EXPECT_NEAR(a[2], b[0], 1e-7 * b.norm());
  }
}

// Three cables on two motions: no two are twins, but rounding makes the rest of their W indefinite.
TEST(DirectSolver, RedundantRowsBehindWeldsAreSolved) {
  Random random(24);
  const std::vector<int> rows{0, 1, 2};
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    MatrixX ways(3, 2);
    for (double& way : ways.reshaped()) way = random.uniform(-1.0, 1.0);
    const VectorX free = ways * Eigen::Vector2d(random.uniform(-1.0, 1.0), 0.3);
    StepProblem problem = behind_welds(ways * ways.transpose(), free, rows, random);
    solve_and_obey(problem);
  }
}

// A brake and a motor in one hinge, so W contains the row twice: the motor follows its command, and
// the brake opposes it exactly at its limit, or is idle if nothing moves.
TEST(DirectSolver, ABrakeBesideWhatHoldsItsRowIsAtItsLimit) {
  Random random(18);
  for (int trial = 0; trial < 200; ++trial) {
    BlockCounts counts = random_counts(random);
    counts.owned = counts.capstans = 0;
    counts.held = 1;
    RandomProblem robot = random_problem(counts, random);
    StepProblem& problem = robot.problem;
    const auto motor = std::ranges::find_if(problem.actuators, &ActuatorBlock::holds_motion);
    ASSERT_NE(motor, problem.actuators.end());
    const Eigen::Index rows = problem.delta_free.size();
    problem.compliance.conservativeResize(rows + 1, rows + 1);
    problem.compliance.row(rows).head(rows) = problem.compliance.row(motor->row).head(rows);
    problem.compliance.col(rows) = problem.compliance.col(motor->row);
    problem.compliance(rows, rows) = problem.compliance(motor->row, motor->row);
    problem.delta_free.conservativeResize(rows + 1);
    problem.delta_free[rows] = problem.delta_free[motor->row];
    problem.delta = problem.delta_free;
    ActuatorBlock brake;
    brake.row = static_cast<int>(rows);
    brake.effort_min = -0.3;
    brake.effort_max = 0.3;
    brake.motion_min = -kInfinity;
    brake.motion_max = kInfinity;
    brake.kind = CommandKind::motion;
    const int way = random.integer(-1, 1);
    brake.value = motor->value - 0.1 * way;
    problem.actuators.push_back(brake);
    std::vector<double> effort(static_cast<std::size_t>(rows) + 1, 0.0);
    DirectSolver solver;
    solver.begin_step();
    ASSERT_EQ(solver.solve(problem, effort), LawStatus::solved) << trial;
    EXPECT_EQ(effort.back(), -0.3 * way) << trial;
    problem.delta = robot.motion(effort);
    EXPECT_LT(violation(problem, effort, LawStatus::solved), 1e-8) << trial;
  }
}

// The problem that results if springs at `rows` are added to A (Sherman, Morrison & Woodbury).
StepProblem anchored(const StepProblem& problem, const std::vector<int>& rows, double stiffness) {
  StepProblem result = problem;
  const auto count = static_cast<Eigen::Index>(rows.size());
  MatrixX columns(problem.compliance.rows(), count), own(count, count);
  VectorX stretch(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const int row = rows[static_cast<std::size_t>(k)];
    columns.col(k) = problem.compliance.col(row);
    stretch[k] = problem.delta_free[row] - problem.delta[row];
    result.stiffness.push_back({row, -stiffness});
  }
  for (Eigen::Index k = 0; k < count; ++k)
    own.row(k) = columns.row(rows[static_cast<std::size_t>(k)]);
  own.diagonal().array() += 1.0 / stiffness;
  const MatrixX inverse = own.inverse();
  result.compliance -= columns * inverse * columns.transpose();
  result.delta_free -= columns * inverse * stretch;
  return result;
}

TEST(DirectSolver, AnchorsChangeNothing) {
  Random random(8);
  for (int trial = 0; trial < 200; ++trial) {
    BlockCounts counts = random_counts(random);
    counts.effectors = 3;
    RandomProblem robot = random_problem(counts, random);
    const auto rows = static_cast<std::size_t>(robot.problem.delta_free.size());
    const int last = static_cast<int>(rows);
    robot.problem.delta += 0.1 * random.vector(last);
    const StepProblem with =
        anchored(robot.problem, {last - 3, last - 2, last - 1}, random.uniform(0.1, 100.0));
    std::vector<double> plain(rows, 0.0), held(rows, 0.0);
    for (const ActuatorBlock& block : robot.problem.actuators) {
      if (!block.owned) continue;
      const auto row = static_cast<std::size_t>(block.row);
      plain[row] = held[row] = random.uniform(0.0, 1.0);
    }
    DirectSolver solver;
    solver.begin_step();
    ASSERT_EQ(solver.solve(robot.problem, plain), LawStatus::solved) << trial;
    solver.begin_step();
    ASSERT_EQ(solver.solve(with, held), LawStatus::solved) << trial;
    for (std::size_t row = 0; row + 3 < rows; ++row) {
      EXPECT_NEAR(held[row], plain[row], 1e-6 * (1.0 + std::abs(plain[row]))) << trial;
    }
    const Eigen::Map<const VectorX> all(held.data(), last);
    const VectorX motion = with.delta_free + with.compliance * all;
    EXPECT_LT((motion - robot.motion(plain)).norm(), 1e-6 * (1.0 + motion.norm())) << trial;
    Response response, with_anchors;
    response.form(robot.problem, plain);
    with_anchors.form(with, held);
    if (response.compliance().cols() == 0) continue;
    const double off = (response.compliance() - with_anchors.compliance()).norm();
    EXPECT_LT(off, 1e-5 * (1.0 + response.compliance().norm())) << trial;
  }
}

// The stability of an anchored robot is that without the anchors.
TEST(Stabilised, CountsWithoutAnchors) {
  Random random(9);
  for (int trial = 0; trial < 100; ++trial) {
    const MatrixX root = random.matrix(6, 8);
    MatrixX stiffness = root * root.transpose();
    const bool stable = trial % 2 == 0;
    if (!stable) stiffness(2, 2) -= 1.1 / stiffness.inverse()(2, 2);
    StepProblem problem;
    const double spring = 10.0 * stiffness.norm();
    MatrixX with = stiffness;
    for (int row = 0; row < 3; ++row) {
      with(row, row) += spring;
      problem.stiffness.push_back({row, -spring});
    }
    problem.compliance = with.inverse();
    problem.delta_free = problem.delta = VectorX::Zero(6);
    EXPECT_EQ(stabilised(problem, 0), stable) << trial;
  }
}

// A taut cable holds a robot that is unstable alone, as a hinge without limits would; it cannot
// push.
TEST(Brace, ATautCableHoldsWhatIsUnstableAlone) {
  Random random(10);
  for (int trial = 0; trial < 100; ++trial) {
    const MatrixX root = random.matrix(4, 6);
    MatrixX stiffness = root * root.transpose();
    stiffness(0, 0) -= 1.5 / stiffness.inverse()(0, 0);  // negative along the cable's row
    StepProblem problem;
    problem.compliance = stiffness.inverse();
    problem.delta_free = problem.delta = random.vector(4);
    problem.actuators.push_back({.row = 0,
                                 .effort_min = 0.0,
                                 .effort_max = kInfinity,
                                 .motion_min = -kInfinity,
                                 .motion_max = kInfinity,
                                 .kind = CommandKind::motion,
                                 .value = random.uniform(-1.0, 1.0)});
    ActuatorBlock& cable = problem.actuators.front();
    std::vector<double> effort(4, 0.0);
    EXPECT_FALSE(stabilised(problem, 1)) << trial;
    EXPECT_FALSE(brace(problem, effort, 1)) << trial;  // slack
    EXPECT_FALSE(cable.braced);
    effort[0] = 1.0;
    ASSERT_TRUE(brace(problem, effort, 1)) << trial;
    EXPECT_FALSE(brace(problem, effort, 2)) << trial;  // one cable holds one direction
    ASSERT_TRUE(brace(problem, effort, 1)) << trial;

    // The tension is that of a bilateral row at this motion, if it pulls.
    const double needed = (cable.value - problem.delta_free[0]) / problem.compliance(0, 0);
    DirectSolver solver;
    solver.begin_step();
    const LawStatus status = solver.solve(problem, effort);
    EXPECT_EQ(status, needed > 0.0 ? LawStatus::solved : LawStatus::failed) << trial;
    if (needed > 0.0) {
      EXPECT_NEAR(effort[0], needed, 1e-9 * needed) << trial;
    }
    release_braces(problem);
    EXPECT_FALSE(stabilised(problem, 1)) << trial;
  }
}

// A stop that is reached holds its motion, too, on its side of the command.
TEST(Brace, AStopHoldsOnItsSide) {
  const ActuatorBlock block{.row = 0,
                            .effort_min = -10.0,
                            .effort_max = 10.0,
                            .motion_min = -1.0,
                            .motion_max = 2.0,
                            .kind = CommandKind::effort,
                            .value = 3.0};
  EXPECT_EQ(block.held(1.0), 2.0);
  EXPECT_EQ(block.held(5.0), -1.0);
  EXPECT_EQ(block.held(3.0), std::nullopt);
  EXPECT_EQ(block.held(10.0), std::nullopt);
  ActuatorBlock free = block;
  free.motion_max = kInfinity;
  EXPECT_EQ(free.held(1.0), std::nullopt);
  free.owned = true;
  EXPECT_EQ(free.held(5.0), std::nullopt);
}

// A row that moves nothing takes its commanded effort. If its motion is commanded and already
// reached, it takes the smallest effort within its limits; otherwise the limit on that side, and
// without a limit there is no solution.
TEST(DirectSolver, WhatMovesNothingTakesLeastEffort) {
  StepProblem problem;
  problem.compliance = MatrixX::Zero(4, 4);
  problem.delta_free = VectorX::Constant(4, -1.0);
  problem.delta = problem.delta_free;
  for (int row = 0; row < 4; ++row) {
    ActuatorBlock block;
    block.row = row;
    block.effort_max = 9.0;
    block.motion_min = -kInfinity;
    block.motion_max = kInfinity;
    block.kind = row == 0 ? CommandKind::effort : CommandKind::motion;
    block.value = row == 0 || row == 3 ? 2.0 : -1.0;
    if (row == 2) block.effort_min = 0.5;
    problem.actuators.push_back(block);
  }
  std::vector<double> effort(4, 7.0);
  DirectSolver solver;
  ASSERT_EQ(solver.solve(problem, effort), LawStatus::solved);
  EXPECT_EQ(effort, (std::vector<double>{2.0, 0.0, 0.5, 9.0}));
  problem.actuators[3].effort_max = kInfinity;
  EXPECT_EQ(solver.solve(problem, effort), LawStatus::failed);
}

}  // namespace
}  // namespace sinew::law
