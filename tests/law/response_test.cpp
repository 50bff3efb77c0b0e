#include "sinew/law/response.hpp"

#include <array>

#include <gtest/gtest.h>

#include "sinew/law/certificate.hpp"
#include "sinew/law/controller.hpp"
#include "sinew/law/direct_solver.hpp"
#include "sinew/law/step_solver.hpp"
#include "sinew/qp/quadratic_program.hpp"

#include "problems.hpp"

namespace sinew::law {
namespace {

using testing::BlockCounts;
using testing::Random;
using testing::random_problem;
using testing::RandomProblem;

constexpr int kOwned = 2;

BlockCounts counts_beside_a_controller(Random& random) {
  BlockCounts counts;
  counts.owned = kOwned;
  counts.commanded_efforts = random.integer(0, 1);
  counts.stopped_efforts = random.integer(0, 1);
  counts.motions = random.integer(0, 2);
  counts.held = random.integer(0, 1);
  counts.drives = random.integer(0, 1);
  counts.capstans = random.integer(0, 2);
  counts.contacts = random.integer(0, 2);
  counts.bilaterals = random.integer(0, 1);
  counts.effectors = 2;
  return counts;
}

std::vector<double> solve_direct(const StepProblem& problem, std::vector<double> effort) {
  DirectSolver solver({.tolerance = 1e-12});
  solver.begin_step();
  EXPECT_EQ(solver.solve(problem, effort), LawStatus::solved);
  return effort;
}

// The response is the derivative of the direct solution, except where a block changes its state
// within the difference.
TEST(Response, IsTheDerivativeOfTheDirectSolution) {
  Random random(11);
  constexpr double kStep = 1e-6;
  int compared = 0, skipped = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const RandomProblem robot = random_problem(counts_beside_a_controller(random), random);
    std::vector<double> start(static_cast<std::size_t>(robot.problem.delta_free.size()), 0.0);
    for (int k = 0; k < kOwned; ++k) start[static_cast<std::size_t>(k)] = random.uniform(0.2, 1.0);
    const std::vector<double> here = solve_direct(robot.problem, start);
    Response response;
    response.form(robot.problem, here);
    ASSERT_EQ(response.controlled(), (std::vector<int>{0, 1}));
    const VectorX owned = Eigen::Map<const VectorX>(here.data(), kOwned);
    // It is exact at the given efforts.
    const VectorX at = response.free() + response.compliance() * owned;
    EXPECT_LT((at - robot.motion(here)).cwiseAbs().maxCoeff(), 1e-7) << trial;
    for (int k = 0; k < kOwned; ++k) {
      std::vector<double> moved = here;
      moved[static_cast<std::size_t>(k)] += kStep;
      moved = solve_direct(robot.problem, moved);
      Response there;
      there.form(robot.problem, here);
      there.form(robot.problem, moved);
      if (!there.same_states()) {
        ++skipped;
        continue;
      }
      const VectorX difference = (robot.motion(moved) - robot.motion(here)) / kStep;
      EXPECT_LT((difference - response.compliance().col(k)).cwiseAbs().maxCoeff(), 2e-4) << trial;
      ++compared;
    }
  }
  EXPECT_GT(compared, 700);
  EXPECT_LT(skipped, 20);
}

/// Controller that brings the last rows nearest to a goal: least squares without limits.
class Nearest : public Controller {
 public:
  explicit Nearest(VectorX goal) : goal_(std::move(goal)) {}
  void begin_choices(const StepProblem&, const Response&) override {}
  LawStatus choose(const StepProblem&, const Response& response, Guards guarded,
                   std::span<double> effort) override {
    const MatrixX rows = response.compliance().bottomRows(goal_.size());
    const VectorX gap = response.free().tail(goal_.size()) - goal_;
    const auto guards = guarded != Guards::none ? static_cast<int>(response.guards().size()) : 0;
    auto program = qp::QuadraticProgram::sized(kOwned, guards);
    program.hessian = rows.transpose() * rows;
    program.gradient = rows.transpose() * gap;
    for (int g = 0; g < guards; ++g) {
      const auto number = static_cast<std::size_t>(g);
      program.rows.row(g) = response.guard_slope(number).transpose();
      program.row_lower[g] = -response.guards()[number].offset;
      if (guarded == Guards::tight && response.guards()[number].tight) {
        program.row_upper[g] = program.row_lower[g];
      }
    }
    qp::QpSolver solver(kOwned, guards);
    const qp::QpResult& result = solver.solve(program);
    if (result.status != qp::QpStatus::optimal) return LawStatus::failed;
    std::ranges::copy(result.x, effort.begin());
    multipliers_.assign(result.row_multiplier.begin(), result.row_multiplier.end());
    foreseen_ = 0.5 * (rows * result.x + gap).squaredNorm();
    ++calls;
    return LawStatus::solved;
  }
  double foreseen() const override { return foreseen_; }
  std::span<const double> guard_multipliers() const override { return multipliers_; }
  Merit merit(const StepProblem&, const VectorX& motion, std::span<const double>,
              std::span<const double>) const override {
    return {0.0, 0.5 * (motion.tail(goal_.size()) - goal_).squaredNorm()};
  }
  double negligible_gain() const override { return 1e-16; }
  void accept(const StepProblem&, const Response&, const VectorX& motion, std::span<const double>,
              std::span<const double>) override {
    accepted = motion;
  }
  void begin_step(int) override {}
  void hold_back(int) override {}
  VectorX accepted;
  int calls = 0;

 private:
  VectorX goal_;
  double foreseen_ = 0.0;
  std::vector<double> multipliers_;
};

// Through contacts, drives, passive actuators and friction, the controller reaches its goal in the
// step's problem, and all other blocks obey their laws.
TEST(StepSolver, AControllerReachesItsGoalThroughAnyBlocks) {
  Random random(12);
  int reached = 0, trials = 300;
  for (int trial = 0; trial < trials; ++trial) {
    RandomProblem robot = random_problem(counts_beside_a_controller(random), random);
    const auto rows = static_cast<std::size_t>(robot.problem.delta_free.size());
    // A goal that is reachable.
    std::vector<double> wanted(rows, 0.0);
    for (int k = 0; k < kOwned; ++k) wanted[static_cast<std::size_t>(k)] = random.uniform(0.0, 1.0);
    wanted = solve_direct(robot.problem, wanted);
    const VectorX goal = robot.motion(wanted).tail(2);
    Nearest controller(goal);
    StepSolver solver({.tolerance = 1e-12});
    solver.begin_step();
    std::vector<double> effort(rows, 0.0);
    ASSERT_EQ(solver.solve(robot.problem, &controller, effort), LawStatus::solved);
    EXPECT_LE(controller.calls, 40);
    robot.problem.delta = robot.motion(effort);
    EXPECT_LT((controller.accepted - robot.problem.delta).norm(), 1e-12);
    EXPECT_LT(violation(robot.problem, effort, LawStatus::solved), 1e-8) << trial;
    if ((robot.problem.delta.tail(2) - goal).norm() < 1e-6) ++reached;
  }
  // The other trials end at a local optimum where blocks change their states.
  EXPECT_GE(reached, trials * 97 / 100);
}

// Without friction every piece is a convex program, and the best of all 2^k pieces is the optimum
// of the mathematical program with complementarity constraints. The solver ends at a stationary
// point, usually this optimum.
TEST(StepSolver, EndsWhereNoNeighbouringPieceServesBetter) {
  Random random(14);
  constexpr int kTrials = 1020;  // of which 20 have twelve contacts
  int global = 0, between = 0, at_limits = 0;
  std::array<int, 5> kinds{};
  double largest_loss = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    BlockCounts counts;
    counts.owned = kOwned;
    counts.contacts = trial < 1000 ? random.integer(1, 4) : 12;
    counts.effectors = 2;
    RandomProblem robot = random_problem(counts, random);
    for (ContactBlock& contact : robot.problem.contacts) contact.friction = 0.0;
    const VectorX goal = 3.0 * random.vector(2);
    Nearest controller(goal);
    StepSolver solver({.tolerance = 1e-12});
    solver.begin_step();
    std::vector<double> effort(static_cast<std::size_t>(robot.problem.delta_free.size()), 0.0);
    ASSERT_EQ(solver.solve(robot.problem, &controller, effort), LawStatus::solved);
    const double found = controller.merit(robot.problem, robot.motion(effort), {}, effort).value;
    Response piece;
    piece.form(robot.problem, effort);
    const std::vector<BlockState> own(piece.states().begin(), piece.states().end());
    const Certificate certificate =
        certify(robot.problem, controller, effort, {.tolerance = 1e-12});
    double best = found, neighbour = found, nearby = found;
    std::vector<double> choice(kOwned);
    for (unsigned bits = 0; bits < 1U << own.size(); ++bits) {
      std::vector<BlockState> states(own.size());
      int changed = 0;
      for (std::size_t k = 0; k < own.size(); ++k) {
        states[k] = (bits >> k & 1U) != 0 ? BlockState::slips : BlockState::open;
        changed += states[k] != own[k] ? 1 : 0;
      }
      piece.form_as(robot.problem, effort, states);
      if (controller.choose(robot.problem, piece, Guards::kept, choice) != LawStatus::solved)
        continue;
      best = std::min(best, controller.foreseen());
      // Considers only neighbouring pieces that contain the solver's solution.
      const bool begins_here = std::ranges::all_of(piece.guards(), [&](const Guard& guard) {
        const auto number = static_cast<std::size_t>(&guard - piece.guards().data());
        const VectorX at = Eigen::Map<const VectorX>(effort.data(), kOwned);
        return guard.offset + piece.guard_slope(number).dot(at) >= -1e-9;
      });
      if (begins_here) nearby = std::min(nearby, controller.foreseen());
      if (begins_here && changed <= 1) neighbour = std::min(neighbour, controller.foreseen());
    }
    EXPECT_GE(neighbour, found - 1e-9 * (1.0 + found)) << trial;
    EXPECT_LT(certificate.violation, 1e-8) << trial;
    EXPECT_LT(certificate.stays, 1e-8) << trial;
    EXPECT_LT(certificate.cold, 1e-8) << trial;  // definite W, no friction
    ASSERT_NE(certificate.stationarity, Stationarity::none) << trial;
    EXPECT_EQ(certificate.best_nearby, nearby >= found - 1e-8 * (1.0 + found)) << trial;
    ++kinds[static_cast<std::size_t>(certificate.stationarity)];
    if (certificate.between > 0) ++at_limits;
    if (best >= found - 1e-9 * (1.0 + found)) ++global;
    largest_loss = std::max(largest_loss, std::sqrt(2.0 * found) - std::sqrt(2.0 * best));
    if (controller.calls > 7) ++between;
  }
  RecordProperty("global_of_1020", global);

  RecordProperty("largest_loss", std::to_string(largest_loss));
  EXPECT_GE(global, kTrials * 95 / 100);
  EXPECT_GT(between, 20);
  EXPECT_GT(at_limits, 20);
  EXPECT_EQ(kinds.back(), kTrials);  // strongly stationary
}

// Evaluates the best point where every contact has neither gap nor force, whatever its kind of
// stationarity: the certificate must agree with the adjacent pieces.
TEST(Certificate, NamesTheStationarityOfAnyPlace) {
  Random random(15);
  std::array<int, 5> kinds{};
  for (int trial = 0; trial < 2000; ++trial) {
    BlockCounts counts;
    counts.owned = kOwned;
    counts.contacts = random.integer(1, 2);
    counts.effectors = 3;
    RandomProblem robot = random_problem(counts, random);
    for (ContactBlock& contact : robot.problem.contacts) contact.friction = 0.0;
    Nearest controller(3.0 * random.vector(3));
    std::vector<double> effort(static_cast<std::size_t>(robot.problem.delta_free.size()), 0.0);
    std::vector<double> choice(kOwned);
    Response piece;
    const std::vector<BlockState> open(robot.problem.contacts.size(), BlockState::open);
    piece.form_as(robot.problem, effort, open);
    piece.tighten(choice, 1e30);
    ASSERT_EQ(controller.choose(robot.problem, piece, Guards::tight, choice), LawStatus::solved);
    for (int k = 0; k < kOwned; ++k) {
      const int row = robot.problem.actuators[static_cast<std::size_t>(piece.controlled()[k])].row;
      effort[static_cast<std::size_t>(row)] = choice[static_cast<std::size_t>(k)];
    }
    DirectSolver direct({.tolerance = 1e-12});
    direct.begin_step();
    ASSERT_EQ(direct.solve(robot.problem, effort), LawStatus::solved);
    const Certificate found = certify(robot.problem, controller, effort, {.tolerance = 1e-12});
    ASSERT_EQ(found.between, counts.contacts) << trial;
    ASSERT_NE(found.stationarity, Stationarity::none) << trial;
    ++kinds[static_cast<std::size_t>(found.stationarity)];
    const double value = controller.merit(robot.problem, robot.motion(effort), {}, effort).value;
    double best = value;
    for (unsigned bits = 0; bits < 1U << open.size(); ++bits) {
      std::vector<BlockState> states = open;
      for (std::size_t k = 0; k < states.size(); ++k) {
        if ((bits >> k & 1U) != 0) states[k] = BlockState::slips;
      }
      piece.form_as(robot.problem, effort, states);
      if (controller.choose(robot.problem, piece, Guards::kept, choice) != LawStatus::solved)
        continue;
      best = std::min(best, controller.foreseen());
    }
    EXPECT_EQ(found.best_nearby, best >= value - 1e-8 * (1.0 + value)) << trial;
    if (found.stationarity == Stationarity::strong) {
      EXPECT_GE(best, value - 1e-8 * (1.0 + value));
    }
  }
  for (const int count : kinds) RecordProperty("count", count);
  EXPECT_GT(kinds[static_cast<std::size_t>(Stationarity::strong)], 20);
  EXPECT_GT(kinds[static_cast<std::size_t>(Stationarity::weak)], 20);
  EXPECT_GT(kinds[static_cast<std::size_t>(Stationarity::clarke)], 20);

  // A point that is not optimal in any piece.
  BlockCounts counts;
  counts.owned = kOwned;
  counts.contacts = 2;
  counts.effectors = 2;
  RandomProblem robot = random_problem(counts, random);
  Nearest controller(3.0 * random.vector(2));
  std::vector<double> effort(static_cast<std::size_t>(robot.problem.delta_free.size()), 0.0);
  DirectSolver direct({.tolerance = 1e-12});
  direct.begin_step();
  ASSERT_EQ(direct.solve(robot.problem, effort), LawStatus::solved);
  const Certificate found = certify(robot.problem, controller, effort, {});
  EXPECT_EQ(found.stationarity, Stationarity::none);
  EXPECT_FALSE(found.best_nearby);
}

TEST(StepSolver, AControllerAloneChoosesOnce) {
  Random random(13);
  BlockCounts counts;
  counts.owned = kOwned;
  counts.commanded_efforts = 1;
  counts.effectors = 2;
  const RandomProblem robot = random_problem(counts, random);
  Nearest controller(VectorX::Zero(2));
  StepSolver solver;
  std::vector<double> effort(static_cast<std::size_t>(robot.problem.delta_free.size()), 0.0);
  ASSERT_EQ(solver.solve(robot.problem, &controller, effort), LawStatus::solved);
  EXPECT_EQ(controller.calls, 1);
}

}  // namespace
}  // namespace sinew::law
