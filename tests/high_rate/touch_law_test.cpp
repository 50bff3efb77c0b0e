// Hands and contacts against an independent solution, and their slopes against differences.
#include "sinew/high_rate/touch_law.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "sinew/qp/quadratic_program.hpp"
#include "sinew/qp/solve_cones.hpp"

#include "snapshots.hpp"

namespace sinew::high_rate {
namespace {

using sinew::testing::random_snapshot;
using sinew::testing::robot_settings;
using sinew::testing::spread;

VectorX random_efforts(const HighRateSettings& settings, Random& random) {
  VectorX efforts(settings.driving());
  for (double& effort : efforts) effort = 5.0 * spread(random);
  return efforts;
}

VectorX motions(const HighRateSettings& settings, const Snapshot& snapshot, const VectorX& driving,
                const TouchLaw& law) {
  return snapshot.free + snapshot.compliance.leftCols(driving.size()) * driving +
         snapshot.compliance.middleCols(settings.free_rows(), law.rows()) * law.effort();
}

TEST(TouchLaw, ContactsAreThoseOfTheConeSolver) {
  const HighRateSettings settings = robot_settings(0);
  Random random(7);
  int closed = 0, open = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Snapshot snapshot = random_snapshot(settings, random, trial % 2 == 0 ? 0.3 : 0.0);
    TouchLaw law(settings);
    law.begin(snapshot);
    const VectorX driving = random_efforts(settings, random);
    law.settle(driving, VectorX());
    const int first = settings.free_rows();
    const VectorX offset =
        snapshot.free.tail(law.rows()) +
        snapshot.compliance.block(first, 0, law.rows(), driving.size()) * driving;
    const auto wanted =
        qp::solve_cones(snapshot.compliance.bottomRightCorner(law.rows(), law.rows()), offset,
                        snapshot.friction, 1e-12);
    ASSERT_EQ(wanted.status, qp::ConeStatus::solved);
    EXPECT_LT((law.effort() - wanted.x).norm(), 1e-6 * (1.0 + wanted.x.norm())) << trial;
    EXPECT_LT(law.residual(), 1e-7) << trial;
    for (const auto state : wanted.states) {
      ++(state == qp::ContactState::open ? open : closed);
    }
  }
  EXPECT_GT(closed, 50);
  EXPECT_GT(open, 50);
}

// Hands without contacts form a quadratic program.
TEST(TouchLaw, HandsAreThoseOfAQuadraticProgram) {
  HighRateSettings settings = robot_settings(3, 0);
  settings.hands[1].max = 0.5;
  settings.hands[2].min = -0.4;
  Random random(8);
  for (int trial = 0; trial < 40; ++trial) {
    const Snapshot snapshot = random_snapshot(settings, random);
    TouchLaw law(settings);
    law.begin(snapshot);
    const VectorX driving = random_efforts(settings, random);
    VectorX hands(3);
    for (double& place : hands) place = 2e-3 * spread(random);
    law.settle(driving, hands);
    qp::QuadraticProgram program = qp::QuadraticProgram::sized(3, 0);
    program.hessian = snapshot.compliance.bottomRightCorner(3, 3);
    program.gradient = snapshot.free.tail(3) +
                       snapshot.compliance.bottomLeftCorner(3, driving.size()) * driving - hands;
    for (int h = 0; h < 3; ++h) {
      program.lower[h] = settings.hands[static_cast<std::size_t>(h)].min;
      program.upper[h] = settings.hands[static_cast<std::size_t>(h)].max;
    }
    qp::QpSolver solver(3, 0);
    EXPECT_LT((law.effort() - solver.solve(program).x).norm(), 1e-6) << trial;
  }
}

// As long as no state changes, settle() agrees with the slopes.
TEST(TouchLaw, SlopesAreThoseOfDifferences) {
  const HighRateSettings settings = robot_settings(2);
  Random random(9);
  int compared = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Snapshot snapshot = random_snapshot(settings, random);
    TouchLaw law(settings);
    law.begin(snapshot);
    const VectorX driving = random_efforts(settings, random);
    VectorX hands(2);
    for (double& place : hands) place = 2e-3 * spread(random);
    law.settle(driving, hands);
    law.settle(driving, hands);  // by the states' equations, without the cone solver
    const VectorX foretold = law.free() + law.compliance() * driving;
    const VectorX touch = law.touch_free() + law.touch_slope() * driving;
    EXPECT_LT((foretold - motions(settings, snapshot, driving, law).head(foretold.size())).norm(),
              1e-9);
    EXPECT_LT((touch - law.effort()).norm(), 1e-6 * (1.0 + touch.norm()));

    const VectorX way = 1e-7 * random_efforts(settings, random);
    const VectorX ahead = law.compliance() * way;
    const VectorX touch_ahead = law.touch_slope() * way;
    const MatrixX stiffness = law.hand_stiffness();
    const VectorX before = motions(settings, snapshot, driving, law), effort = law.effort();
    const long work = law.factorisations();
    law.settle(driving + way, hands);
    const VectorX moved = motions(settings, snapshot, driving + way, law) - before;
    const bool changes = law.factorisations() != work;
    if (!changes) {
      ++compared;
      EXPECT_LT((moved.head(ahead.size()) - ahead).norm(), 1e-5 * ahead.norm()) << trial;
      EXPECT_LT((law.effort() - effort - touch_ahead).norm(), 1e-5 * touch_ahead.norm()) << trial;
    }
    law.settle(driving, hands);
    const VectorX here = law.effort();
    const VectorX shift = VectorX::Constant(2, 1e-9);
    law.settle(driving, hands + shift);
    if (law.factorisations() != work) continue;
    EXPECT_LT((law.effort().head(2) - here.head(2) - stiffness * shift).norm(),
              1e-4 * (stiffness * shift).norm() + 1e-12);
  }
  EXPECT_GT(compared, 20);
}

TEST(TouchLaw, StoredEnergyIsWhatAHandGetsBack) {
  HighRateSettings settings = robot_settings(2, 0);
  settings.hands[1].max = 0.3;
  Random random(10);
  const Snapshot snapshot = random_snapshot(settings, random);
  TouchLaw law(settings);
  law.begin(snapshot);
  const VectorX driving = VectorX::Zero(settings.driving());
  const VectorX start = snapshot.free.tail(2);
  const VectorX way = VectorX::Constant(2, 3e-3);
  double work = 0.0;
  constexpr int kSteps = 20000;
  for (int k = 0; k < kSteps; ++k) {  // midpoint rule
    law.settle(driving, start + way * ((k + 0.5) / kSteps));
    work += law.effort().head(2).dot(way) / kSteps;
  }
  law.settle(driving, start + way);
  EXPECT_GT(work, 1e-4);
  EXPECT_NEAR(law.stored(), work, 1e-5 * work);
  EXPECT_EQ(law.effort()[1], 0.3);
}

TEST(TouchLaw, AHandThatIsNotThereHasNoEffort) {
  const HighRateSettings settings = robot_settings(2, 3);
  Random random(11);
  const Snapshot snapshot = random_snapshot(settings, random);
  TouchLaw law(settings);
  law.begin(snapshot);
  const VectorX driving = VectorX::Zero(settings.driving());
  VectorX hands = snapshot.free.segment(settings.free_rows(), 2).array() + 1e-3;
  law.settle(driving, hands);
  EXPECT_GT(law.effort()[0], 0.0);
  hands[0] = std::nan("");
  law.settle(driving, hands);
  EXPECT_EQ(law.effort()[0], 0.0);
  EXPECT_LT(law.residual(), 1e-8);
  hands[0] = snapshot.free[settings.free_rows()] + 1e-3;
  law.settle(driving, hands);
  EXPECT_GT(law.effort()[0], 0.0);
}

// Two equal contacts share the force of one.
TEST(TouchLaw, RedundantContactsAreSolved) {
  const HighRateSettings settings = robot_settings(0, 2);
  Random random(12);
  Snapshot snapshot = random_snapshot(settings, random);
  const int first = settings.free_rows();
  for (int c = 0; c < 3; ++c) {
    snapshot.compliance.row(first + 3 + c) = snapshot.compliance.row(first + c);
    snapshot.free[first + 3 + c] = snapshot.free[first + c];
  }
  for (int c = 0; c < 3; ++c) {
    snapshot.compliance.col(first + 3 + c) = snapshot.compliance.col(first + c);
  }
  snapshot.free[first] = snapshot.free[first + 3] = -1e-3;
  TouchLaw law(settings);
  law.begin(snapshot);
  law.settle(VectorX::Zero(settings.driving()), VectorX());
  EXPECT_LT(law.residual(), 1e-6);
  EXPECT_GT(law.effort()[0] + law.effort()[3], 0.0);
  EXPECT_TRUE(law.compliance().allFinite());
}

}  // namespace
}  // namespace sinew::high_rate
