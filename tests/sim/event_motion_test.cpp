// Impacts on surfaces with prescribed motion, against closed forms of the relative motion.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/state.hpp"

#include "event_robots.hpp"

namespace sinew::testing {
namespace {

constexpr double kBall = 0.05;  // m, radius
constexpr double kOver = 0.35;  // m, initial height of its lowest point above the table

model::BaseMotion rising(double speed, double start = 0.0) {
  model::BaseMotion motion;
  motion.translation[2] = model::Signal::ramp({0.0, 10.0 * speed, start, 10.0});
  return motion;
}

// The support of the ball: a surface of the world, or a body given by a shape or a mesh.
enum class Table { plane, shape, mesh };

std::unique_ptr<sim::Simulation> ball_on(Table table, const model::BaseMotion& motion,
                                         const model::StepSettings& step, double above = kOver) {
  builder::ModelBuilder builder(step);
  const int ball = add_ball(builder, "ball", Vector3(0.013, -0.021, above + kBall));
  if (table == Table::plane) {
    builder::ContactSettings contact;
    contact.name = "table";
    contact.body = ball;
    contact.surface = collision::Plane{};
    contact.motion = motion;
    builder.add_contact(contact);
  } else {
    const int body = add_slab(builder, "table", table == Table::mesh);
    model::BaseMotion own = motion;
    own.body = body;
    builder.add_base_motion(own, {});
    add_pair(builder, ball, body);
  }
  return std::make_unique<sim::Simulation>(builder.build());
}

double height(const sim::Simulation& simulation) { return pose(simulation, 0).origin()[2] - kBall; }

double speed(const sim::Simulation& simulation) { return pose(simulation, 0).linear_velocity()[2]; }

class MovingTable : public ::testing::TestWithParam<Table> {};

// On a table that rises at constant speed, the ball bounces as on a resting one: it approaches with
// the table's speed added. On a mesh it lands on the lowest corner of its own triangles, which is
// below its centre.
TEST_P(MovingTable, RisesUnderABouncingBall) {
  const double e = 0.6, rise = 0.4, h = 20e-3;
  const auto simulation = ball_on(GetParam(), rising(rise), events(h, e));
  const double small = 1e-9;
  const double above = GetParam() == Table::mesh ? kApart : 0.0;
  // State of the ball relative to the table at the start of a flight.
  double at = kOver - above, rate = -rise, begin = 0.0;
  const double end =
      std::sqrt(rise * rise + 2.0 * kGravity * at) / kGravity * (1.0 + e) / (1.0 - e);
  while (simulation->time() < 0.8 * end) {
    simulation->step();
    const double time = simulation->time();
    for (;;) {
      const double left = (rate + std::sqrt(rate * rate + 2.0 * kGravity * at)) / kGravity;
      if (begin + left > time) break;
      rate = e * (kGravity * left - rate);
      begin += left;
      at = 0.0;
    }
    const double t = time - begin;
    EXPECT_NEAR(height(*simulation) - rise * time - above, at + rate * t - 0.5 * kGravity * t * t,
                small)
        << "at " << time;
    EXPECT_NEAR(speed(*simulation) - rise, rate - kGravity * t, 10.0 * small) << "at " << time;
  }
}

// The ball rests on an oscillating table and follows it: midpoint steps are of second order.
TEST_P(MovingTable, SwingsWithABallOnIt) {
  model::BaseMotion swing;
  swing.translation[2] = model::Signal::sine({0.0, 5e-3, 1.0, 0.0});
  const double pace = 2.0 * M_PI;
  const auto simulation = ball_on(GetParam(), swing, events(10e-3, 0.5), 0.0);
  // The table's velocity jumps at the start and hits the ball, which then comes to rest on it.
  while (simulation->time() < 0.2) simulation->step();
  const double start = height(*simulation) - 5e-3 * std::sin(pace * simulation->time());
  int impacts = 0;
  while (simulation->time() < 0.7) {
    impacts += simulation->step().impacts;
    const double phase = pace * simulation->time();
    EXPECT_NEAR(height(*simulation) - 5e-3 * std::sin(phase), start, 1e-9);
    EXPECT_NEAR(speed(*simulation), 5e-3 * pace * std::cos(phase), 1e-9);
  }
  EXPECT_EQ(impacts, 0);
}

// A table whose velocity jumps throws the ball with (1 + e) times its speed.
TEST_P(MovingTable, StartsAtOnceAndThrowsTheBall) {
  const double e = 0.5, rise = 0.3, start = 0.0437;
  const auto simulation = ball_on(GetParam(), rising(rise, start), events(10e-3, e), 0.0);
  int impacts = 0;
  while (simulation->time() < 0.0549) impacts += simulation->step().impacts;
  if (GetParam() == Table::mesh) {  // corners of one face may strike one after the other
    EXPECT_GE(impacts, 1);
  } else {
    EXPECT_EQ(impacts, 1);
  }
  EXPECT_NEAR(speed(*simulation), (1.0 + e) * rise - kGravity * (simulation->time() - start), 1e-6);
}

TEST_P(MovingTable, GoesOnFromAStateBitForBit) {
  const int pauses[] = {5, 25};
  expect_same_run(*ball_on(GetParam(), rising(0.4), events(20e-3, 0.8)), pauses, 5, 2);
}

INSTANTIATE_TEST_SUITE_P(Tables, MovingTable,
                         ::testing::Values(Table::plane, Table::shape, Table::mesh));

// The work of the floor on the ball is external work; an impact dissipates (1 - e^2) of the kinetic
// energy relative to the floor.
TEST(EventMotion, EnergiesAddUp) {
  const double e = 0.6, rise = 0.4, mass = 2.0;
  const auto simulation = ball_on(Table::plane, rising(rise), events(20e-3, e));
  const double start = simulation->energies().total();
  double dissipated = 0.0;
  double approach = std::sqrt(rise * rise + 2.0 * kGravity * kOver);
  while (simulation->time() < 1.2) {
    for (int impacts = simulation->step().impacts; impacts > 0; --impacts) {
      dissipated += 0.5 * mass * (1.0 - e * e) * approach * approach;
      approach *= e;
    }
    const run::EnergyLedger& ledger = simulation->ledger();
    EXPECT_NEAR(ledger.dissipated, dissipated, 1e-8);
    EXPECT_NEAR(simulation->energies().total() - start, ledger.outside - ledger.dissipated, 1e-8);
  }
}

// A floor that rotates about a distant line hits the ball with its local velocity. Within a substep
// of length h the normal at the ball rotates, so its gap is off by up to r (w h)^2/8 = 1.4e-6 m.
TEST(EventMotion, AFloorThatTurnsStrikes) {
  const double e = 0.7, pace = 1.5, beside = 0.4;
  builder::ModelBuilder builder(events(10e-3, e));
  const int ball =
      add_ball(builder, "ball", Vector3(beside, 0.0, 0.2), Vector3::Zero(), Vector3::Zero());
  builder::ContactSettings floor;
  floor.name = "floor";
  floor.body = ball;
  floor.surface = collision::Plane{};
  floor.motion.emplace();
  floor.motion->axis = -Vector3::UnitY();
  floor.motion->angle = model::Signal::ramp({0.0, 10.0 * pace, 0.0, 10.0});
  builder.add_contact(floor);
  sim::Simulation simulation(builder.build());
  // The ball rests at (x, z) and is hit when z cos a - x sin a = r.
  const double far = std::hypot(beside, 0.2);
  const double angle = std::atan2(0.2, beside) - std::asin(kBall / far);
  const double along = std::sqrt(far * far - kBall * kBall);  // lever arm of the contact point
  int impacts = 0;
  while (simulation.time() < angle / pace + 0.02) impacts += simulation.step().impacts;
  EXPECT_EQ(impacts, 1);
  const Vector3 normal(-std::sin(angle), 0.0, std::cos(angle));
  EXPECT_LT((pose(simulation, 0).linear_velocity() - (1.0 + e) * pace * along * normal).norm(),
            1e-6);
}

// A ball at rest on a moving belt slides until it rolls: the contact point slips with the belt's
// speed V, and friction gives the ball 2/7 of it, which leaves 5/7 V relative to the belt. Under
// the midpoint rule a slip of less than 5 % of the speed changes sign from step to step, so the
// mean of two steps is tested.
TEST(EventMotion, ABeltCarriesABall) {
  builder::ModelBuilder builder(events(5e-3, 0.0));
  const int ball = add_ball(builder, "ball", Vector3(0.0, 0.0, kBall));
  builder::ContactSettings belt;
  belt.name = "belt";
  belt.body = ball;
  belt.surface = collision::Plane{};
  belt.friction = 0.3;
  belt.motion.emplace();
  belt.motion->translation[0] = model::Signal::ramp({0.0, 10.0, 0.0, 10.0});
  builder.add_contact(belt);
  sim::Simulation simulation(builder.build());
  double before = 0.0;
  while (simulation.time() < 0.5) {
    before = pose(simulation, 0).linear_velocity()[0];
    simulation.step();
  }
  EXPECT_NEAR(0.5 * (before + pose(simulation, 0).linear_velocity()[0]), 2.0 / 7.0, 1e-3);
  EXPECT_NEAR(pose(simulation, 0).origin()[2], kBall, 1e-9);
  // Work of the belt: its force times its displacement.
  const double kinetic = simulation.energies().kinetic;
  EXPECT_NEAR(simulation.ledger().outside - simulation.ledger().dissipated, kinetic, 1e-4);
  EXPECT_NEAR(simulation.ledger().outside, 2.0 * 2.0 / 7.0, 0.02);
}

TEST(EventMotion, SurfacesThatJumpAreRefused) {
  model::BaseMotion jump;
  jump.translation[2] = model::Signal::steps({{0.0, 0.0}, {0.1, 0.01}});
  for (const Table table : {Table::plane, Table::shape}) {
    EXPECT_THROW(ball_on(table, jump, events(10e-3, 0.5)), Error);
  }
}

}  // namespace
}  // namespace sinew::testing
