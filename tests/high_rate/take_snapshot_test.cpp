// Snapshots of simulations, against their linearisation and static solutions.
#include <gtest/gtest.h>

#include "sinew/high_rate/high_rate_settings.hpp"
#include "sinew/high_rate/snapshot.hpp"
#include "sinew/high_rate/touch_law.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/linearisation.hpp"
#include "sinew/sim/simulation.hpp"

#include "../sim/robots.hpp"
#include "../support/error_kind.hpp"

namespace sinew::high_rate {
namespace {

using sinew::testing::beam;
using sinew::testing::BeamOptions;
using sinew::testing::kind_of;
using sinew::testing::pull;
using sinew::testing::tension;

const SnapshotRows kAllCables{.driven = {"cable_0", "cable_1", "cable_2", "cable_3"},
                              .unknown = {},
                              .effectors = {"tip"},
                              .hands = {}};

statics::StaticSettings precise() { return {}; }

TEST(TakeSnapshot, IsTheLinearisationWhereTheLoopDrivesEverything) {
  sim::Simulation simulation(beam());
  simulation.command(0, tension(1.5));
  simulation.command(1, tension(0.5));
  simulation.solve_static();
  const run::State before = simulation.state();
  const Snapshot snapshot = take_snapshot(simulation, kAllCables, 12);
  EXPECT_TRUE(simulation.state() == before);
  const sim::Linearisation all = sim::linearise(simulation);
  ASSERT_EQ(snapshot.rows(), 7);
  EXPECT_LT((snapshot.compliance.leftCols(4) - all.compliance.leftCols(4)).norm(),
            1e-9 * all.compliance.norm());
  EXPECT_LT((snapshot.free - all.delta_free).norm(), 1e-9);
  EXPECT_LT((snapshot.effort - all.effort).norm(), 1e-12);
  EXPECT_EQ(snapshot.contacts(), 0);
  EXPECT_GT(snapshot.size, 0.09);
  HighRateSettings settings;
  settings.driven.resize(4);
  settings.observed = 3;
  EXPECT_NO_THROW(check(snapshot, settings));
}

// Cables that the loop does not drive are held at their lengths.
TEST(TakeSnapshot, HoldsWhatIsCommanded) {
  sim::Simulation simulation(beam());
  simulation.command(0, tension(1.0));
  simulation.command(1, pull(2e-3));
  simulation.step();
  simulation.solve_static(precise());
  ASSERT_GT(simulation.actuator(1).effort, 0.1);
  const SnapshotRows rows{{"cable_0"}, {}, {"tip"}, {}};
  const Snapshot snapshot = take_snapshot(simulation, rows, 0);
  const double change = 1e-3;
  const Vector3 here = simulation.effector_value(0);
  simulation.command(0, tension(1.0 + change));
  simulation.solve_static(precise());
  const Vector3 moved = (simulation.effector_value(0) - here) / change;
  const Vector3 foreseen = snapshot.compliance.col(0).tail<3>();
  EXPECT_LT((moved - foreseen).norm(), 2e-3 * foreseen.norm());
  const Snapshot free = take_snapshot(simulation, kAllCables, 0);
  EXPECT_GT((free.compliance.col(0).tail<3>() - foreseen).norm(), 0.01 * foreseen.norm())
      << "without the held cable it would go elsewhere";
}

// A beam pulled onto a wall: the law on the snapshot gives the equilibrium's forces and predicts
// the tip's motion when it is pulled harder.
TEST(TakeSnapshot, ContactsAnswerAsInTheSimulation) {
  BeamOptions options;
  options.wall = -0.011;
  options.wall_friction = 0.0;
  sim::Simulation simulation(beam(options));
  simulation.command(2, tension(2.0));
  simulation.solve_static(precise());
  const SnapshotRows rows{{"cable_2"}, {}, {"tip"}, {}};
  const Snapshot snapshot = take_snapshot(simulation, rows, 12);
  ASSERT_GT(snapshot.contacts(), 0);
  HighRateSettings settings;
  settings.driven.resize(1);
  settings.observed = 3;
  TouchLaw law(settings);
  law.begin(snapshot);
  const VectorX effort = snapshot.effort.head(1);
  law.settle(effort, VectorX());
  const VectorX wanted = snapshot.effort.tail(law.rows());
  EXPECT_GT(wanted.norm(), 0.01);
  EXPECT_LT((law.effort() - wanted).norm(), 1e-3 * wanted.norm());

  const double change = 1e-3;
  const Vector3 here = simulation.effector_value(0);
  const Vector3 foreseen = law.compliance().col(0).tail<3>();
  simulation.command(2, tension(2.0 + change));
  simulation.solve_static(precise());
  const Vector3 moved = (simulation.effector_value(0) - here) / change;
  EXPECT_LT((moved - foreseen).norm(), 1e-2 * foreseen.norm());
  EXPECT_GT((snapshot.compliance.block<3, 1>(1, 0) - foreseen).norm(), 0.1 * foreseen.norm())
      << "contacts take part in the motion";
  EXPECT_EQ(take_snapshot(simulation, rows, 2).contacts(), 2);
}

TEST(TakeSnapshot, NamesWhatIsWrong) {
  sim::Simulation simulation(beam());
  const auto refused = [&](const SnapshotRows& rows) {
    return kind_of([&] { take_snapshot(simulation, rows, 0); });
  };
  EXPECT_EQ(refused({{"cable_9"}, {}, {}, {}}), ErrorKind::unknown_name);
  EXPECT_EQ(refused({{}, {}, {"top"}, {}}), ErrorKind::unknown_name);
  EXPECT_EQ(refused({{"cable_0"}, {"cable_0"}, {}, {}}), ErrorKind::bad_argument);
}

}  // namespace
}  // namespace sinew::high_rate
